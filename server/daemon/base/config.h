/* The command line of `reposed`, and a file of the same names. */
#ifndef CONFIG_H
#define CONFIG_H

#include <stdbool.h>
#include <stddef.h>

enum { CONFIG_HOSTS = 8, CONFIG_MOST_WORKERS = 256 };

/* Not to be copied: some members point into it. */
typedef struct config {
    const char *command;  /* what is to be done: "serve", ... */
    const char *argument; /* of that command; NULL: none */
    const char *file;     /* that options were read from; NULL: none */
    const char *host, *data, *token_file, *port_file;
    const char *public_url; /* without / at the end; NULL: none */
    char public_host[256];  /* of it, without the port; "": none */
    int port, workers, threads, queue_limit;
    int address_rate; /* requests a second of one address */
    bool confine;     /* workers, to their folders */
    bool on_slurm;    /* workers run in Slurm's jobs, of which all that begins so is told */
    int slurm_queue, slurm_bundle_seconds;
    double slurm_longest;
    const char *slurm_partition, *slurm_account, *slurm_qos, *slurm_constraint;
    const char *slurm_line[CONFIG_HOSTS];
    int slurm_lines;
    const char *slurm_allowed[CONFIG_HOSTS]; /* what jobs may ask for (job_resources.h) */
    int slurm_allowances;
    const char *worker, *web, *api_file;
    const char *allowed_host[CONFIG_HOSTS]; /* names besides localhost by which clients may call us */
    int allowed_hosts;
    const char *allowed_origin[CONFIG_HOSTS]; /* whose pages may use the service: scheme://host[:port] */
    int allowed_origins;
    const char *callback_host[CONFIG_HOSTS]; /* that may be called back */
    int callback_hosts;
    int keep_days;                                                  /* after its end a job is deleted; 0: never */
    double keep_bytes;                                              /* that the folders of jobs may take; 0: any number */
    double max_estimate_seconds, max_particles, max_snapshot_bytes; /* that one POST may ask for; 0: any */
    int max_threads;
    bool log_json; /* lines of the log are JSON */
    bool wait;     /* until what was submitted has ended */
    bool json;     /* what is shown, as JSON */
    bool repair;   /* what is found is to be mended */
    bool dry_run;  /* nothing is to be removed */

    bool is_installed; /* by `make install` or a package: what the program needs lies where these put it */
    int word_count;    /* the command line, for reading it again */
    char **word;
    char *file_text; /* owned: what strings that the file gave point into */
    char public_url_kept[300], worker_found[4096], web_found[4096], api_found[4096];
} config;

/* What to do after reading; for CONFIG_WRONG and CONFIG_SHOWN everything has been said. */
enum config_outcome { CONFIG_READ, CONFIG_SHOWN, CONFIG_WRONG };
enum config_outcome config_read(config *settings, int argc, char **argv);
/* The file and the command line of a running service once more, as they are now. False: all problems are logged, and `fresh` is
 * of no use. Either way it is to be cleared when nobody uses its strings any more. */
bool config_read_again(config *fresh, const config *running);
void config_clear(config *settings);
/* Logs in what the two differ. What takes a restart is set in `fresh` as it is in `running`. The number of differences that do not
 * take one. */
int config_compare(config *fresh, const config *running);

#endif
