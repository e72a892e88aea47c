/* The results document of a flow: the table's numbers, and the profile along the orifice. */
#include "orifice_result.h"

#include "orifice_process.h"
#include "standing_result.h"

json_t *orifice_result_to_json(const orifice_result *result)
{
    json_t *document = results_to_json(&orifice_result_fields, result);
    json_t *profile = profile_to_json(&result->velocity, "radius", "velocity");
    json_t *solid = profile_to_json(&result->solid_fraction, "radius", "solid_fraction");
    const bool is_whole = document && profile && solid
                          && json_object_set(profile, "solid_fraction", json_object_get(solid, "solid_fraction")) == 0
                          && json_object_set(json_object_get(document, "outlet"), "profile", profile) == 0;
    json_decref(profile);
    json_decref(solid);
    if (is_whole) return document;
    json_decref(document);
    return NULL;
}
