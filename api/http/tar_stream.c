#include "tar_stream.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BLOCK = 512, READ_AT_ONCE = 256 << 10, NAME_SIZE = 100 };
#define LARGEST_IN_OCTAL 077777777777ULL

typedef struct tar_stream {
    job_store *store;
    char id[JOB_ID_SIZE];
    json_t *files; /* "result.json", "snapshots/000000.hdf", ... */
    size_t next;   /* of files */
    int file;      /* being sent, or -1 */
    uint64_t left; /* bytes of it */
    size_t padding;
    bool is_over;
} tar_stream;

static bool note_file(void *context, const char *folder, const char *name)
{
    json_t *path = json_sprintf("%s%s%s", folder ? folder : "", folder ? "/" : "", name);
    return !path || json_array_append_new(context, path) == 0; /* a name that is no text of ours is left out */
}

/* Large sizes as GNU tar and others have them: the first bit set, then a number of base 256. */
static void write_size(char *field, uint64_t size)
{
    if (size <= LARGEST_IN_OCTAL) {
        snprintf(field, 12, "%011llo", (unsigned long long)size);
        return;
    }
    memset(field, 0, 12);
    field[0] = (char)0x80;
    for (int k = 11; k > 3; k--, size >>= 8) field[k] = (char)(size & 0xFF);
}

static void add_header(text_buffer *out, const char *id, const char *path, const struct stat *facts)
{
    char header[BLOCK] = { 0 };
    snprintf(header, NAME_SIZE, "%s/%s", id, path);
    memcpy(header + 100, "0000644", 8);
    memcpy(header + 108, "0000000", 8);
    memcpy(header + 116, "0000000", 8);
    write_size(header + 124, (uint64_t)facts->st_size);
    snprintf(header + 136, 12, "%011llo", (unsigned long long)facts->st_mtim.tv_sec & LARGEST_IN_OCTAL);
    memset(header + 148, ' ', 8); /* of the checksum, while it is summed */
    header[156] = '0';
    memcpy(header + 257, "ustar", 6);
    memcpy(header + 263, "00", 2);
    unsigned sum = 0;
    for (int k = 0; k < BLOCK; k++) sum += (unsigned char)header[k];
    snprintf(header + 148, 8, "%06o", sum);
    header[155] = ' ';
    text_buffer_add(out, header, BLOCK);
}

static void add_zeros(text_buffer *out, size_t count)
{
    static const char zeros[2 * BLOCK];
    text_buffer_add(out, zeros, count);
}

/* One that has gone meanwhile, or is no plain file, is passed over. */
static void begin_file(tar_stream *tar, text_buffer *out)
{
    const char *path = json_string_value(json_array_get(tar->files, tar->next++));
    const char *slash = strchr(path, '/');
    char folder[NAME_SIZE] = "";
    struct stat facts;
    if (strlen(tar->id) + 1 + strlen(path) >= NAME_SIZE) return;
    if (slash) snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
    if (store_open_file(tar->store, tar->id, slash ? folder : NULL, slash ? slash + 1 : path, &tar->file) != STORE_OK) return;
    if (fstat(tar->file, &facts) != 0 || !S_ISREG(facts.st_mode)) {
        close(tar->file);
        tar->file = -1;
        return;
    }
    add_header(out, tar->id, path, &facts);
    tar->left = (uint64_t)facts.st_size;
    tar->padding = (size_t)(BLOCK - tar->left % BLOCK) % BLOCK;
}

/* False: the disk. */
static bool go_on_with_file(tar_stream *tar, text_buffer *out)
{
    char piece[16 << 10];
    for (size_t sent = 0; tar->left > 0 && sent < READ_AT_ONCE;) {
        const size_t wanted = tar->left < sizeof piece ? (size_t)tar->left : sizeof piece;
        ssize_t got = read(tar->file, piece, wanted);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return false;
        if (got == 0) {
            memset(piece, 0, wanted);
            got = (ssize_t)wanted;
        }
        text_buffer_add(out, piece, (size_t)got);
        tar->left -= (size_t)got;
        sent += (size_t)got;
    }
    if (tar->left > 0) return true;
    add_zeros(out, tar->padding);
    close(tar->file);
    tar->file = -1;
    return true;
}

static bool add_piece(void *context, text_buffer *out)
{
    tar_stream *tar = context;
    while (out->length < READ_AT_ONCE && !tar->is_over) {
        if (tar->file >= 0) {
            if (!go_on_with_file(tar, out)) return false;
        } else if (tar->next < json_array_size(tar->files)) {
            begin_file(tar, out);
        } else {
            add_zeros(out, 2 * BLOCK);
            tar->is_over = true;
        }
    }
    return !out->failed;
}

static void free_tar(void *context)
{
    tar_stream *tar = context;
    if (tar->file >= 0) close(tar->file);
    json_decref(tar->files);
    free(tar);
}

bool tar_stream_open(job_store *store, const char *id, http_pieces *pieces)
{
    tar_stream *tar = calloc(1, sizeof *tar);
    json_t *files = json_array();
    if (!tar || !files || store_list_files(store, id, note_file, files) != STORE_OK) {
        json_decref(files);
        free(tar);
        return false;
    }
    tar->store = store;
    tar->file = -1;
    tar->files = files;
    snprintf(tar->id, sizeof tar->id, "%s", id);
    *pieces = (http_pieces){ add_piece, free_tar, tar };
    return true;
}
