/* The results document of a heap: the table's numbers, and the words beside them. */
#include "heap_result.h"

#include "heap_process.h"
#include "standing_result.h"

json_t *heap_result_to_json(const heap_result *result)
{
    const char *name[DEM_HEAP_METHODS];
    for (int m = 0; m < DEM_HEAP_METHODS; m++) name[m] = dem_heap_method_name((dem_heap_method)m);
    heap_result whole = *result;
    whole.method = name[0];
    json_t *document = results_to_json(&heap_result_fields, &whole);
    if (document && angle_methods_add(json_object_get(document, "repose"), result->measured.angle, DEM_HEAP_METHODS, name)
        && json_object_set_new(json_object_get(document, "surface"), "profile",
                               profile_to_json(&result->measured.surface, "radius", "height"))
               == 0)
        return document;
    json_decref(document);
    return NULL;
}
