/* JSON documents, and what is done to them: {"target", "patch", "pointer", "value"}. The merged document is held against
 * RFC 7396 rule by rule, and nothing that is put into a document shows in the one that it was copied from. Any document
 * may also be taken for calibration.json. */
#include <math.h>
#include <string.h>

#include "calibration.h"
#include "fuzz.h"
#include "json_pointer.h"
#include "json_text.h"
#include "merge_patch.h"

static void text_reads_back(const json_t *document)
{
    problem_list problems;
    char *text = json_text_write(document);
    CLAIM(text && problem_list_init(&problems));
    json_t *again = json_text_load(text, strlen(text), &problems);
    CLAIM(again && json_equal(again, document));
    json_decref(again);
    problem_list_clear(&problems);
    free(text);
}

/* RFC 7396, section 2, said of a result instead of made. target: NULL where there was nothing. */
static void is_merged(const json_t *result, const json_t *target, const json_t *patch)
{
    const char *name;
    json_t *value;
    if (!json_is_object(patch)) {
        CLAIM(json_equal(result, patch));
        return;
    }
    CLAIM(json_is_object(result));
    size_t members = 0;
    json_object_foreach((json_t *)patch, name, value)
    {
        const json_t *merged = json_object_get(result, name);
        CLAIM(json_is_null(value) == !merged);
        if (!merged) continue;
        is_merged(merged, json_object_get(target, name), value);
        members++;
    }
    json_object_foreach((json_t *)target, name, value)
    {
        if (json_object_get(patch, name)) continue;
        CLAIM(json_equal(json_object_get(result, name), value));
        members++;
    }
    CLAIM(members == json_object_size(result));
}

static void merge(const json_t *target, const json_t *patch)
{
    json_t *target_before = json_deep_copy(target), *patch_before = json_deep_copy(patch);
    json_t *result = json_merge_patch(target, patch);
    CLAIM(result);
    is_merged(result, target, patch);
    CLAIM(!target || json_equal(target, target_before));
    CLAIM(json_equal(patch, patch_before));
    json_decref(result);
    json_decref(target_before);
    json_decref(patch_before);
}

static void put(json_t *target, const char *pointer, const json_t *value)
{
    json_t *before = json_deep_copy(target), *changed = json_copy(target);
    CLAIM(before && changed);
    json_pointer_find(target, pointer);
    if (json_pointer_is_valid(pointer) && json_pointer_set(changed, pointer, value))
        CLAIM(json_equal(json_pointer_find(changed, pointer), value));
    CLAIM(json_equal(target, before));
    json_decref(changed);
    json_decref(before);
}

/* The pointer to each member, made of its name, leads to it. */
static void names_are_found(const json_t *object)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)object, name, value)
    {
        char pointer[JSON_POINTER_SIZE] = "";
        if (json_pointer_append(pointer, name)) CLAIM(json_pointer_find(object, pointer) == value);
        else CLAIM(strlen(name) > JSON_POINTER_SIZE / 2 - 2);
    }
}

static void calibrate(const json_t *document)
{
    calibration machine;
    calibration_from_json(document, &machine);
    for (int law = 0; law < CALIBRATION_LAWS; law++) {
        const calibration_load load = { 3000, 4, (dem_contact_law)law, 0.1, true, true, 2 };
        const double seconds = calibration_seconds_a_run(&machine, &load, 1000);
        CLAIM(isfinite(seconds) && seconds > 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    problem_list problems;
    CLAIM(problem_list_init(&problems));
    json_t *document = json_text_load((const char *)bytes, size, &problems);
    CLAIM(!document == !problem_list_is_empty(&problems));
    if (document) {
        json_t *target = json_object_get(document, "target"), *patch = json_object_get(document, "patch");
        const char *pointer = json_string_value(json_object_get(document, "pointer"));
        const json_t *value = json_object_get(document, "value");
        text_reads_back(document);
        names_are_found(document);
        calibrate(document);
        if (patch) merge(target, patch);
        if (target && pointer && value) put(target, pointer, value);
    }
    json_decref(document);
    problem_list_clear(&problems);
    return 0;
}
