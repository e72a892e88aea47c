/* The list of processes. */
#include "drum_process.h"
#include "fill_process.h"
#include "granule_process.h"
#include "heap_process.h"
#include "orifice_process.h"

#include <stdio.h>
#include <string.h>

const process_type *const process_types[] = {
    &drum_process, &fill_process, &heap_process, &granule_process, &orifice_process, NULL
};

const process_type *process_type_find(const char *name)
{
    for (size_t p = 0; process_types[p]; p++)
        if (strcmp(process_types[p]->name, name) == 0) return process_types[p];
    return NULL;
}

void process_type_names(char *text, size_t size)
{
    text[0] = '\0';
    for (size_t p = 0; process_types[p]; p++) {
        const size_t length = strlen(text);
        snprintf(text + length, size - length, "%s\"%s\"", p ? ", " : "", process_types[p]->name);
    }
}
