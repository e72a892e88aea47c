/* JSON Merge Patch, RFC 7396: what a case of a study says differently from the study's base. */
#ifndef MERGE_PATCH_H
#define MERGE_PATCH_H

#include <jansson.h>

/* The target with the patch applied; neither is changed, and what is the same is shared with them. target may be NULL (nothing there). New reference; NULL: no
 * memory. */
json_t *json_merge_patch(const json_t *target, const json_t *patch);

#endif
