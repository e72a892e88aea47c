#include "access.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "log.h"

enum { SHORTEST_TOKEN = 16, LONGEST_FILE = 32768, LONGEST_SINGLE = ACCESS_TOKEN_SIZE + 64 /* with white space around it */ };
#define SECONDS_OF_A_SESSION 43200.0 /* without a request */

/* --- the file --- */

/* The whole file, or as much of it as the buffer holds; -1: errno says why not. */
static ssize_t read_file(const char *path, char *text, size_t size, mode_t *mode)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    struct stat facts = { .st_mode = 0 };
    ssize_t got = file < 0 || fstat(file, &facts) != 0 ? -1 : 1, length = 0;
    while (got > 0 && (size_t)length < size) {
        got = read(file, text + length, size - (size_t)length);
        if (got > 0) length += got;
    }
    const int problem = errno;
    if (file >= 0) close(file);
    errno = problem;
    *mode = facts.st_mode;
    return got < 0 ? -1 : length;
}

static access_token *add(access_list *list, const char *name, access_level level, const char *text, size_t length)
{
    access_token *token = &list->token[list->count++];
    *token = (access_token){ .level = level };
    snprintf(token->name, sizeof token->name, "%s", name);
    memcpy(token->text, text, length);
    return token;
}

/* A file that holds one token and nothing else: it may write. A token is never taken in part: a client that sends all of it
 * would be refused, and who knows a part let in. */
static bool read_single(access_list *list, const char *text, size_t length)
{
    const char *path = list->file;
    size_t first = 0, end = length;
    while (first < end && isspace((unsigned char)text[first])) first++;
    while (end > first && isspace((unsigned char)text[end - 1])) end--;
    size_t plain = first;
    while (plain < end && isgraph((unsigned char)text[plain])) plain++;
    const size_t characters = end - first;
    if (length >= LONGEST_SINGLE)
        log_line("token file %s holds %d characters or more; must hold 16 to %d", path, LONGEST_SINGLE, ACCESS_TOKEN_SIZE - 1);
    else if (characters < SHORTEST_TOKEN || characters >= ACCESS_TOKEN_SIZE)
        log_line("token file %s holds %zu characters; must hold 16 to %d", path, characters, ACCESS_TOKEN_SIZE - 1);
    else if (plain < end)
        log_line("token file %s holds, at character %zu, one that a header can't hold; must hold ASCII without spaces", path,
                 plain - first + 1);
    else return add(list, "token", ACCESS_WRITE, text + first, characters);
    return false;
}

static bool is_name(const char *text)
{
    const size_t length = strlen(text);
    for (const char *c = text; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("_.-", *c)) return false;
    return length > 0 && length < ACCESS_NAME_SIZE;
}

/* NULL, or what is wrong with the line. */
static const char *read_line(access_list *list, char *line)
{
    char *rest = NULL;
    const char *name = strtok_r(line, " \t\r", &rest), *level = strtok_r(NULL, " \t\r", &rest),
               *text = strtok_r(NULL, " \t\r", &rest);
    if (!text || strtok_r(NULL, " \t\r", &rest)) return "must be: name, read or write, token";
    const size_t length = strlen(text);
    const bool reads = strcmp(level, "read") == 0;
    if (!is_name(name)) return "has a name that is not 1 to 40 letters, digits and _ . -";
    if (!reads && strcmp(level, "write") != 0) return "says neither read nor write behind the name";
    for (const char *c = text; *c; c++)
        if (!isgraph((unsigned char)*c)) return "has a token that a header can't hold; must be ASCII";
    if (length < SHORTEST_TOKEN || length >= ACCESS_TOKEN_SIZE) return "has a token that is not 16 to 255 characters long";
    if (list->count == ACCESS_TOKENS) return "is one too many: at most 32 tokens are taken";
    for (int k = 0; k < list->count; k++) {
        if (strcmp(list->token[k].name, name) == 0) return "has a name that is there already";
        if (strcmp(list->token[k].text, text) == 0) return "has a token that is there already";
    }
    add(list, name, reads ? ACCESS_READ : ACCESS_WRITE, text, length);
    return NULL;
}

static bool read_lines(access_list *list, char *text)
{
    int number = 0;
    bool good = true;
    for (char *rest = text, *line; (line = strsep(&rest, "\n"));) {
        number++;
        if (line[strspn(line, " \t\r")] == '\0' || line[strspn(line, " \t")] == '#') continue;
        const char *problem = read_line(list, line);
        if (problem) log_line("token file %s: line %d %s", list->file, number, problem);
        good = good && !problem;
    }
    if (good && list->count == 0) log_line("token file %s has no token", list->file);
    return good && list->count > 0;
}

/* Whether its first line is one of a list: a comment, or three words. */
static bool is_list(const char *text)
{
    text += strspn(text, " \t\r\n");
    int words = 0;
    for (const char *c = text; *c && *c != '\n'; words++) {
        c += strcspn(c, " \t\r\n");
        c += strspn(c, " \t\r");
    }
    return *text == '#' || words >= 3;
}

static bool read_tokens(access_list *list)
{
    char text[LONGEST_FILE + 1];
    mode_t mode;
    const ssize_t length = read_file(list->file, text, LONGEST_FILE, &mode);
    bool good = false;
    if (length < 0) log_line("token file %s can't be read: %s", list->file, strerror(errno));
    else if ((mode & 077) != 0) log_line("token file %s has mode %03o; must be 0600", list->file, (unsigned)mode & 0777U);
    else if (length == LONGEST_FILE) log_line("token file %s is longer than %d bytes", list->file, LONGEST_FILE - 1);
    else {
        text[length] = '\0';
        good = strlen(text) == (size_t)length && is_list(text) ? read_lines(list, text) : read_single(list, text, (size_t)length);
    }
    explicit_bzero(text, sizeof text);
    return good;
}

bool access_open(access_list *list, const char *file)
{
    *list = (access_list){ .file = file };
    pthread_mutex_init(&list->lock, NULL);
    return !file || read_tokens(list);
}

static void take_over(access_list *list, access_list *fresh)
{
    pthread_mutex_lock(&list->lock);
    for (int f = 0; f < fresh->count; f++)
        for (int k = 0; k < list->count; k++)
            if (strcmp(fresh->token[f].text, list->token[k].text) == 0)
                memcpy(fresh->token[f].session, list->token[k].session, sizeof list->token[k].session);
    memcpy(list->token, fresh->token, sizeof list->token);
    list->count = fresh->count;
    pthread_mutex_unlock(&list->lock);
    list->file = fresh->file;
}

bool access_read_again(access_list *list, const char *file)
{
    access_list *fresh = calloc(1, sizeof *fresh);
    if (!fresh) return false;
    fresh->file = file;
    const bool good = !file || read_tokens(fresh);
    if (good) take_over(list, fresh);
    if (good && file) log_line("token file %s read again: %d tokens", file, fresh->count);
    if (!good) log_line("the tokens stay as they were");
    explicit_bzero(fresh, sizeof *fresh);
    free(fresh);
    return good;
}

/* --- comparing --- */

/* Looks at every byte whatever it finds. Both have `size` bytes. */
static bool is_same(const char *one, const char *other, size_t size)
{
    unsigned char difference = 0;
    for (size_t i = 0; i < size; i++) difference |= (unsigned char)(one[i] ^ other[i]);
    return difference == 0;
}

/* With the lock held, and at every token whatever it finds; NULL: none. */
static access_token *find(access_list *list, const char *text)
{
    char given[ACCESS_TOKEN_SIZE] = "";
    access_token *found = NULL;
    const size_t length = strlen(text);
    memcpy(given, text, length < sizeof given ? length : sizeof given);
    for (int k = 0; k < list->count; k++)
        if (is_same(list->token[k].text, given, sizeof given)) found = &list->token[k];
    return length < sizeof given ? found : NULL;
}

access_level access_of_token(access_list *list, const char *token)
{
    pthread_mutex_lock(&list->lock);
    const access_token *found = find(list, token);
    const access_level level = found ? found->level : ACCESS_NONE;
    pthread_mutex_unlock(&list->lock);
    return level;
}

/* --- sessions --- */

/* Of "a=b; reposed_session=...; c=d". */
static bool session_of(const char *cookie, char id[ACCESS_SESSION_SIZE])
{
    static const char name[] = ACCESS_COOKIE "=";
    for (const char *at = cookie; at && *at; at = strchr(at, ';') ? strchr(at, ';') + 1 : NULL) {
        at += strspn(at, " ");
        if (strncmp(at, name, sizeof name - 1) != 0) continue;
        at += sizeof name - 1;
        if (strspn(at, "0123456789abcdef") != ACCESS_SESSION_SIZE - 1
            || (at[ACCESS_SESSION_SIZE - 1] && at[ACCESS_SESSION_SIZE - 1] != ';'))
            return false;
        snprintf(id, ACCESS_SESSION_SIZE, "%s", at);
        return true;
    }
    return false;
}

/* With the lock held. */
static access_session *find_session(access_list *list, const char *cookie, access_level *level)
{
    char id[ACCESS_SESSION_SIZE];
    access_session *found = NULL;
    const double now = monotonic_seconds();
    if (!session_of(cookie, id)) return NULL;
    for (int k = 0; k < list->count; k++) {
        for (access_session *s = list->token[k].session; s < list->token[k].session + ACCESS_SESSIONS; s++) {
            if (!*s->id || !is_same(s->id, id, sizeof id) || now - s->used > SECONDS_OF_A_SESSION) continue;
            found = s;
            *level = list->token[k].level;
        }
    }
    return found;
}

access_level access_of_cookie(access_list *list, const char *cookie)
{
    access_level level = ACCESS_NONE;
    if (!cookie) return level;
    pthread_mutex_lock(&list->lock);
    access_session *session = find_session(list, cookie, &level);
    if (session) session->used = monotonic_seconds();
    pthread_mutex_unlock(&list->lock);
    return level;
}

static bool make_id(char id[ACCESS_SESSION_SIZE])
{
    unsigned char bytes[ACCESS_SESSION_SIZE / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes) return false;
    for (size_t b = 0; b < sizeof bytes; b++) snprintf(id + 2 * b, 3, "%02x", bytes[b]);
    return true;
}

access_level access_begin_session(access_list *list, const char *token, char id[ACCESS_SESSION_SIZE], char name[ACCESS_NAME_SIZE])
{
    access_level level = ACCESS_NONE;
    if (!make_id(id)) return level;
    pthread_mutex_lock(&list->lock);
    access_token *found = find(list, token);
    if (found) {
        access_session *place = found->session;
        for (access_session *s = found->session; s < found->session + ACCESS_SESSIONS; s++)
            if (s->used < place->used) place = s;
        memcpy(place->id, id, sizeof place->id);
        place->used = monotonic_seconds();
        memcpy(name, found->name, sizeof found->name);
        level = found->level;
    }
    pthread_mutex_unlock(&list->lock);
    return level;
}

void access_end_session(access_list *list, const char *cookie)
{
    access_level level;
    if (!cookie) return;
    pthread_mutex_lock(&list->lock);
    access_session *session = find_session(list, cookie, &level);
    if (session) *session = (access_session){ .used = 0.0 };
    pthread_mutex_unlock(&list->lock);
}
