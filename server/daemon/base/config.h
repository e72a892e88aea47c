/* The command line of `reposed serve`. */
#ifndef CONFIG_H
#define CONFIG_H

#include <stdbool.h>

enum { CONFIG_HOSTS = 8, CONFIG_MOST_WORKERS = 256 };

typedef struct config {
    const char *host, *data, *token_file, *port_file;
    const char *public_url; /* without / at the end; NULL: none */
    char public_host[256];  /* of it, without the port; "": none */
    int port, workers, threads, queue_limit;
    char web[4096], worker[4096], api_file[4096];
    const char *allowed_host[CONFIG_HOSTS]; /* names besides localhost by which clients may call us */
    int allowed_hosts;
} config;

/* What to do after reading; for CONFIG_WRONG and CONFIG_SHOWN everything has been said. */
enum config_outcome { CONFIG_SERVE, CONFIG_SHOWN, CONFIG_WRONG };
enum config_outcome config_read(config *settings, int argc, char **argv);

#endif
