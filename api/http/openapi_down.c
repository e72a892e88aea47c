#include "openapi_down.h"

#include <stdbool.h>
#include <string.h>

static void turn_down_schema(json_t *schema);

/* A schema may be true or false in 3.1. */
static void turn_down_member(json_t *object, const char *name)
{
    json_t *schema = json_object_get(object, name);
    if (!schema) return;
    if (json_is_true(schema)) json_object_set_new(object, name, json_object());
    else if (json_is_false(schema)) json_object_set_new(object, name, json_pack("{s:{}}", "not"));
    else turn_down_schema(schema);
}

static void turn_down_list(json_t *list)
{
    size_t i;
    json_t *schema;
    json_array_foreach(list, i, schema) turn_down_schema(schema);
}

static void turn_down_members(json_t *object)
{
    const char *name;
    json_t *schema;
    void *next;
    json_object_foreach_safe(object, next, name, schema) turn_down_member(object, name);
}

static const char *type_of(const json_t *value)
{
    if (json_is_string(value)) return "string";
    if (json_is_integer(value)) return "integer";
    if (json_is_real(value)) return "number";
    if (json_is_boolean(value)) return "boolean";
    return json_is_array(value) ? "array" : "object";
}

static bool take_out_null(json_t *list)
{
    bool found = false;
    for (size_t i = json_array_size(list); i-- > 0;) {
        const json_t *value = json_array_get(list, i);
        if (!json_is_null(value) && !(json_is_string(value) && strcmp(json_string_value(value), "null") == 0)) continue;
        found = true;
        json_array_remove(list, i);
    }
    return found;
}

/* Several types become a choice between schemas of one each. */
static void turn_down_type(json_t *schema)
{
    json_t *type = json_object_get(schema, "type");
    if (json_is_string(type) && strcmp(json_string_value(type), "null") == 0) {
        json_object_set_new(schema, "type", json_string("object"));
        json_object_set_new(schema, "nullable", json_true());
        json_object_set_new(schema, "enum", json_pack("[n]"));
        return;
    }
    if (!json_is_array(type)) return;
    json_t *types = json_deep_copy(type);
    const bool nullable = take_out_null(types);
    json_object_del(schema, "type");
    if (json_array_size(types) == 1) json_object_set(schema, "type", json_array_get(types, 0));
    if (json_array_size(types) == 1 && nullable) json_object_set_new(schema, "nullable", json_true());
    if (json_array_size(types) > 1) {
        json_t *choice = json_array();
        for (size_t i = 0; i < json_array_size(types); i++) {
            json_t *one = json_pack("{s:O}", "type", json_array_get(types, i));
            if (nullable) json_object_set_new(one, "nullable", json_true());
            if (strcmp(json_string_value(json_array_get(types, i)), "array") == 0) json_object_set_new(one, "items", json_object());
            json_array_append_new(choice, one);
        }
        json_object_set_new(schema, json_object_get(schema, "anyOf") ? "x-anyOf" : "anyOf", choice);
    }
    json_decref(types);
}

/* Values that are allowed: without a type beside them null would not be one of them. */
static void turn_down_enum(json_t *schema)
{
    json_t *constant = json_object_get(schema, "const");
    if (constant) json_object_set_new(schema, "enum", json_pack("[O]", constant));
    json_object_del(schema, "const");
    json_t *values = json_object_get(schema, "enum");
    if (!values || json_object_get(schema, "type") || json_object_get(schema, "anyOf")) return;
    json_t *others = json_deep_copy(values);
    if (take_out_null(others)) json_object_set_new(schema, "nullable", json_true());
    json_object_set_new(schema, "type", json_string(type_of(json_array_get(others, 0))));
    json_decref(others);
}

/* A bound that is not reached was a number; now it is a flag beside the bound. */
static void turn_down_bound(json_t *schema, const char *exclusive, const char *bound)
{
    json_t *value = json_object_get(schema, exclusive);
    if (!json_is_number(value)) return;
    json_object_set(schema, bound, value);
    json_object_set_new(schema, exclusive, json_true());
}

static void turn_down_schema(json_t *schema)
{
    static const char *const gone[] = {
        "unevaluatedProperties", "propertyNames",   "prefixItems",       "examples", "$schema", "$comment",
        "contentMediaType",      "contentEncoding", "patternProperties", "if",       "then",    "else"
    };
    static const char *const one[] = { "items", "additionalProperties", "not" };
    static const char *const lists[] = { "oneOf", "anyOf", "allOf" };
    if (!json_is_object(schema) || json_object_get(schema, "$ref")) return;
    json_t *example = json_array_get(json_object_get(schema, "examples"), 0);
    if (example) json_object_set(schema, "example", example);
    if (json_object_get(schema, "prefixItems") && !json_object_get(schema, "items"))
        json_object_set_new(schema, "items", json_object());
    for (size_t i = 0; i < sizeof gone / sizeof gone[0]; i++) json_object_del(schema, gone[i]);
    turn_down_members(json_object_get(schema, "properties"));
    /* additionalProperties may be true or false in 3.0, too */
    for (size_t i = 0; i < sizeof one / sizeof one[0]; i++)
        if (!json_is_boolean(json_object_get(schema, one[i])) || strcmp(one[i], "additionalProperties") != 0)
            turn_down_member(schema, one[i]);
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) turn_down_list(json_object_get(schema, lists[i]));
    turn_down_type(schema);
    turn_down_enum(schema);
    turn_down_bound(schema, "exclusiveMinimum", "minimum");
    turn_down_bound(schema, "exclusiveMaximum", "maximum");
}

/* Whatever holds a schema: parameters, headers, bodies. */
static void turn_down_tree(json_t *node)
{
    const char *name;
    json_t *member;
    size_t i;
    void *next;
    json_object_foreach_safe(node, next, name, member)
    {
        if (strcmp(name, "schema") == 0) turn_down_member(node, name);
        else if (strcmp(name, "schemas") == 0) turn_down_members(member);
        else if (strcmp(name, "example") != 0) turn_down_tree(member);
    }
    json_array_foreach(node, i, member) turn_down_tree(member);
}

/* Those of the path come first, as in the page of documentation that programs make of it. */
static void move_parameters(json_t *path)
{
    const char *name;
    json_t *operation, *shared = json_incref(json_object_get(path, "parameters"));
    json_object_del(path, "parameters");
    json_object_foreach(path, name, operation)
    {
        json_t *all = shared ? json_copy(shared) : json_array();
        if (json_is_object(operation)) {
            json_array_extend(all, json_object_get(operation, "parameters"));
            json_object_set(operation, "parameters", all);
        }
        json_decref(all);
    }
    json_decref(shared);
}

void openapi_turn_down(json_t *document)
{
    const char *name;
    json_t *path, *info = json_object_get(document, "info"), *license = json_object_get(info, "license");
    json_object_set_new(document, "openapi", json_string("3.0.3"));
    json_object_del(info, "summary");
    json_object_del(license, "identifier");
    json_object_del(document, "webhooks");
    json_object_foreach(json_object_get(document, "paths"), name, path) move_parameters(path);
    turn_down_tree(json_object_get(document, "paths"));
    turn_down_tree(json_object_get(document, "components"));
}
