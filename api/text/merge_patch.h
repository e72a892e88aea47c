/* JSON Merge Patch, RFC 7396: what a case of a study says differently from the study's base. */
#ifndef MERGE_PATCH_H
#define MERGE_PATCH_H

#include <jansson.h>

/* Returns the target with the patch applied, as a new reference which shares with both what is the same; neither is changed. target
 * may be NULL: there is nothing yet. NULL: no memory. */
json_t *json_merge_patch(const json_t *target, const json_t *patch);

#endif
