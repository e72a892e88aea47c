/* Who may: tokens from a file, each with a name and what it may do, and the sessions that pages have opened by one of them.
 * Any thread may call. */
#ifndef ACCESS_H
#define ACCESS_H

#include <pthread.h>
#include <stdbool.h>

#include "service.h"

enum {
    ACCESS_TOKENS = 32,
    ACCESS_SESSIONS = 16, /* of a token; a further one takes the place of that which was used least lately */
    ACCESS_TOKEN_SIZE = 256,
    ACCESS_NAME_SIZE = 41,
    ACCESS_SESSION_SIZE = 65
};

typedef struct access_session {
    char id[ACCESS_SESSION_SIZE]; /* "": none */
    double used;                  /* monotonic s */
} access_session;

typedef struct access_token {
    char name[ACCESS_NAME_SIZE];
    char text[ACCESS_TOKEN_SIZE]; /* filled up with zeros */
    access_level level;
    access_session session[ACCESS_SESSIONS];
} access_token;

typedef struct access {
    const char *_Atomic file; /* NULL: nobody is asked */
    pthread_mutex_t lock;
    access_token token[ACCESS_TOKENS];
    int count;
} access_list;

/* file: NULL: none. False: all that is wrong with it is logged. */
bool access_open(access_list *list, const char *file);
/* This file, as it is now; NULL: none any more. What is wrong with it is logged, and leaves all as it was. Sessions go on where
 * their token is there still. */
bool access_read_again(access_list *list, const char *file);

/* The time tells nothing about how a wrong token differs from a right one. */
access_level access_of_token(access_list *list, const char *token);
/* Of the header Cookie; NULL: none was sent. */
access_level access_of_cookie(access_list *list, const char *cookie);
/* ACCESS_NONE: no such token; the id goes into the cookie. */
access_level access_begin_session(access_list *list, const char *token, char id[ACCESS_SESSION_SIZE], char name[ACCESS_NAME_SIZE]);
void access_end_session(access_list *list, const char *cookie);

#define ACCESS_COOKIE "reposed_session"

#endif
