/* The data folder on the disk: DATA/lock, DATA/reposed.sqlite, DATA/calibration.json, DATA/jobs/<id>/. */
#ifndef DATA_FOLDER_H
#define DATA_FOLDER_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct data_folder {
    char path[4000]; /* absolute */
    int jobs;        /* descriptor of DATA/jobs */
    int lock;        /* held while the daemon lives */
} data_folder;

/* Creates what is missing, takes the lock, removes files that were being written when a daemon or worker died.
 * False: the problem is logged; most often a second daemon on the same folder. */
bool data_folder_open(data_folder *data, const char *path);
/* The same, where workers that no daemon knows of may be writing: nothing is removed. */
bool data_folder_open_beside_workers(data_folder *data, const char *path);
void data_folder_close(data_folder *data);

/* Makes jobs/<id> with this spec.json; keeps a folder that has it already, but not a spec.json that says something else. What a
 * crash of the machine takes of it is made again from the table at the next start. False: errno says why. */
bool job_folder_create(const data_folder *data, const char *id, const char *spec);
/* Removes what nobody of ours put there, links above all, from the folder and that of its snapshots: a worker would use none, and
 * could not go on. What a link leads to stays as it is. */
void job_folder_tidy(const data_folder *data, const char *id);
/* From now on the folder, and the files in it that are safe by themselves, are there for good. False: errno says why. */
bool job_folder_sync(const data_folder *data, const char *id);
/* Gives jobs/<id>, which is made where it is missing, the file `name` of job `from` as start.hdf: by a second name for that file, or
 * by a copy where the file system has no links. folder: where the file is in the other job's folder; NULL: at its top. It is safe on
 * the disk after job_folder_sync or data_folder_sync. False: errno says why. */
bool job_folder_add_start(const data_folder *data, const char *id, const char *from, const char *folder, const char *name);
/* Takes back what job_folder_create made; leaves anything else. */
void job_folder_discard(const data_folder *data, const char *id);

/* The folder of a job that is deleted: first it gets another name, by which nobody looks for it, then all in it is removed.
 * False: something is left, also while a worker that has not gone yet has the folder's lock, or after *stopping. */
void job_folder_put_aside(const data_folder *data, const char *id);
bool job_folder_remove(const data_folder *data, const char *id, const atomic_bool *stopping);

int job_folder_open(const data_folder *data, const char *id); /* descriptor, -1 */
/* A file of the folder, or with `folder` not NULL of that folder in it; never through a symbolic link. */
int job_file_open(const data_folder *data, const char *id, const char *folder, const char *name);
/* Whole text of a file up to `limit` bytes, for free(); NULL: it can't be read (errno says why), or it is larger. */
char *job_file_read(const data_folder *data, const char *id, const char *name, size_t limit);
enum { LARGEST_RESULT = 16 << 20 };
/* result.json as the worker wrote it, an object, for free(); NULL: not there, or not whole. With a spec (else NULL) only what a
 * worker made from that, which result.json.sum tells. */
char *job_result_read(const data_folder *data, const char *id, const char *spec);
void job_result_remove(const data_folder *data, const char *id);
/* The settled bed of the job `from`, and the line that tells what it is. False: errno says why; nothing is there then. */
bool job_folder_add_bed(const data_folder *data, const char *id, const char *from, const char *line);
void job_bed_remove(const data_folder *data, const char *id);
bool data_folder_sync(const data_folder *data); /* all that was written so far is safe on the disk */
/* Whether a file can be made, written and kept; it is removed again. False: errno says why. */
bool data_folder_try_write(const data_folder *data);
typedef struct disk_room {
    double bytes, free_bytes, free_inodes; /* of the data folder's disk; NaN: not known */
} disk_room;
disk_room data_folder_room(const data_folder *data);
/* What is left, of bytes or of inodes, is for jobs that run already and for the database: none is to be added. */
/* What has to stay free, for jobs that run. */
void data_folder_kept_room(const data_folder *data, double *bytes, double *inodes);
bool data_folder_is_nearly_full(const data_folder *data);
double data_folder_free_bytes(const data_folder *data); /* NaN: not known */

#endif
