/* What the programs of this folder are asked: name=number on the command line, every one of which must be known. */
#ifndef NAMED_NUMBERS_H
#define NAMED_NUMBERS_H

#include "../unit/core/scene_by_hand.h"

typedef struct named_number {
    const char *name;
    double value; /* unless said otherwise */
} named_number;

/* Reads the arguments into the table, which a row without a name ends. Exits with 2 at one that it does not have. */
static inline void read_named_numbers(int argc, char **argv, named_number *table)
{
    for (int k = 1; k < argc; k++) {
        const char *equals = strchr(argv[k], '=');
        named_number *row = table;
        while (
            row->name
            && (!equals || strlen(row->name) != (size_t)(equals - argv[k]) || strncmp(row->name, argv[k], strlen(row->name)) != 0))
            row++;
        char *end = NULL;
        if (row->name) row->value = strtod(equals + 1, &end);
        if (!end || end == equals + 1 || *end) {
            fprintf(stderr, "%s: not a name=number that this program knows\n", argv[k]);
            exit(2);
        }
    }
}

#endif
