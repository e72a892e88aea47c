#include "merge_patch.h"

/* RFC 7396, section 2: a member that is null goes, an object is merged, anything else (a list, too) replaces. */
static int patch_member(json_t *result, const char *name, const json_t *value)
{
    if (!json_is_null(value)) return json_object_set_new(result, name, json_merge_patch(json_object_get(result, name), value));
    json_object_del(result, name); /* it may not be there, which is as good */
    return 0;
}

json_t *json_merge_patch(const json_t *target, const json_t *patch)
{
    if (!json_is_object(patch)) return json_incref((json_t *)patch);
    json_t *result = json_is_object(target) ? json_copy((json_t *)target) : json_object();
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)patch, name, value)
    {
        if (result && patch_member(result, name, value) != 0) {
            json_decref(result);
            return NULL;
        }
    }
    return result;
}
