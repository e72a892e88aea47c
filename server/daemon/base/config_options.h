/* The table of options: it alone drives reading the command line and the file, and what --help says. */
#ifndef CONFIG_OPTIONS_H
#define CONFIG_OPTIONS_H

#include "config.h"

enum { OPTION_PROBLEM_SIZE = 400, MOST_OPTIONS = 64 };

typedef struct config_option {
    const char *name, *argument; /* argument NULL: it has none, and stands on the command line alone */
    const char *meaning;         /* for --help; \n begins a further line */
    enum { OPTION_WHOLE, OPTION_AMOUNT, OPTION_TEXT, OPTION_FLAG, OPTION_TAKEN } kind;
    size_t offset;    /* in the config: of an int, a double, a const char * or a bool */
    double low, high; /* of a number; an amount may end in k, M, G or T */
    bool may_repeat;
    bool is_live; /* a running service takes another value when it reads its options again */
    /* OPTION_TAKEN: false, and what the value must be, as in `must be ...`. */
    bool (*take)(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE]);
    bool (*is_same)(const config *one, const config *other);
} config_option;

extern const config_option config_options[];
extern const size_t config_option_count;

/* NULL: there is none of that name. */
const config_option *config_option_named(const char *name);
/* The value, a string that lives as long as the settings. False: problem says what it must be. */
bool config_option_take(const config_option *option, config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE]);
/* Whether both have the same value of it. */
bool config_option_is_same(const config_option *option, const config *one, const config *other);
/* Its value for people: "8080", "none". */
void config_option_text(const config_option *option, const config *settings, char *text, size_t size);

#endif
