#include "spec_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "file_publish.h"
#include "json_text.h"

json_t *spec_file_read(const char *name, problem_list *problems)
{
    size_t length;
    errno = 0;
    char *text = file_read(name, SPEC_FILE_LONGEST, &length);
    if (!text) {
        problem_list_add(problems, "", "can't read %.200s: %s", name, errno ? strerror(errno) : "it is longer than 20 MB");
        return NULL;
    }
    json_t *document = json_text_load(text, length, problems);
    free(text);
    return document;
}

bool spec_file_load(const char *name, const start_source *beds, uint64_t seed_if_missing, job_spec *spec, problem_list *problems)
{
    json_t *request = spec_file_read(name, problems);
    const bool read = request && job_spec_parse_with(beds, NULL, request, seed_if_missing, spec, problems);
    json_decref(request);
    return read;
}
