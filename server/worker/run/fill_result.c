/* The results document of a fill: the table's numbers, and the words beside them. */
#include "fill_result.h"

#include "fill_process.h"
#include "standing_result.h"

json_t *fill_result_to_json(const fill_result *result)
{
    const char *name[DEM_FILL_METHODS];
    for (int m = 0; m < DEM_FILL_METHODS; m++) name[m] = dem_fill_method_name((dem_fill_method)m);
    fill_result whole = *result;
    whole.method = name[0];
    json_t *document = results_to_json(&fill_result_fields, &whole);
    if (document && angle_methods_add(json_object_get(document, "repose"), result->measured.angle, DEM_FILL_METHODS, name)
        && (json_object_set_new(json_object_get(document, "surface"), "profile",
                                profile_to_json(&result->measured.surface, "radius", "height"))
            | json_object_set_new(json_object_get(document, "packing"), "profile",
                                  profile_to_json(&result->measured.packing, "height", "solid_fraction")))
               == 0)
        return document;
    json_decref(document);
    return NULL;
}
