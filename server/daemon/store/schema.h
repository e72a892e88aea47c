/* All tables but those of inputs and results, one migration after the other: number n brings a database from user_version n
 * to n + 1. */
#ifndef SCHEMA_H
#define SCHEMA_H

typedef struct schema_migration {
    const char *parts[6]; /* SQL, run one after the other; NULL: none */
} schema_migration;

extern const schema_migration schema_migrations[];
extern const int schema_version;             /* of this program */
enum { SCHEMA_APPLICATION_ID = 0x72657073 }; /* "reps" */

#endif
