/* Between two looks at the clock a statement runs through a stretch of its program without a jump, and through all of
 * it at most once. So the instructions of the whole program, times what each may do with the longest text, bound how far
 * it can outlast its time; and its registers, times the longest text, bound its memory. EXPLAIN tells both. */
#include "query_cost.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "query_functions.h"

enum {
    COSTLY_BYTES = 256 << 20,  /* of all costly instructions together: some 0.5 s */
    REGISTER_BYTES = 64 << 20, /* of all registers together */
    PLAIN_BYTES = 128 << 20,   /* the same, of a statement that makes no text of its own */
    LONGEST_STORED = 16 << 20,
    MOST_REGISTERS = 1 << 17
};

typedef struct program {
    int64_t costly, registers; /* instructions that work on whole texts; registers that may hold one */
    bool makes_texts;
    uint8_t seen[MOST_REGISTERS / 8];
} program;

static bool is_one_of(const char *list, const char *name, size_t length)
{
    char wanted[40];
    snprintf(wanted, sizeof wanted, " %.*s ", length < 36 ? (int)length : 36, name);
    return strstr(list, wanted) != NULL;
}

static void add_register(program *all, int number)
{
    if (number < 0 || number >= MOST_REGISTERS) return;
    const uint8_t bit = (uint8_t)(1U << (number % 8));
    all->registers += !(all->seen[number / 8] & bit);
    all->seen[number / 8] |= bit;
}

/* What these answer with is a number, or a text of some bytes. */
static bool answers_briefly(const char *function, size_t length)
{
    static const char brief[] = " instr like glob length unicode typeof abs round sign json_valid json_array_length julianday"
                                " unixepoch ceil ceiling trunc degrees radians exp ln log log10 log2 mod pi pow power sqrt"
                                " sin cos tan asin acos atan atan2 ";
    return is_one_of(brief, function, length);
}

/* An instruction that is not listed counts: it may look at all of its text. */
static void add_instruction(program *all, sqlite3_stmt *row)
{
    static const char brief[] = " Init Goto Gosub Return Halt Transaction OpenRead OpenEphemeral OpenPseudo OpenAutoindex Close"
                                " Once Rewind Last Next Prev SorterNext SorterOpen Rowid SeekRowid NotExists DeferredSeek NullRow"
                                " Null Integer Int64 Real String8 String Blob Variable Copy SCopy Move CollSeq ResultRow Column"
                                " SorterData InitCoroutine EndCoroutine Yield Explain Noop IfPos DecrJumpZero OffsetLimit NewRowid"
                                " Sequence IdxRowid IsNull NotNull VOpen VFilter VColumn VNext ReopenIdx ResetSorter ";
    static const char plain[] = " Concat Function PureFunc AggStep AggStep1 AggInverse AggValue AggFinal ";
    const char *opcode = (const char *)sqlite3_column_text(row, 1), *function = (const char *)sqlite3_column_text(row, 5);
    if (!opcode) return;
    const bool calls = is_one_of(" Function PureFunc ", opcode, strlen(opcode));
    if (!function) function = "";
    const size_t length = strcspn(function, "(");
    if (calls && !query_function_is_ours(function, length)) all->costly += 2;
    else if (!calls && !is_one_of(brief, opcode, strlen(opcode))) all->costly++;
    if (is_one_of(plain, opcode, strlen(opcode))) all->makes_texts = true;
    if (is_one_of(" Column VColumn Concat ", opcode, strlen(opcode)) || (calls && !answers_briefly(function, length)))
        add_register(all, sqlite3_column_int(row, 4));
}

static program *read_program(sqlite3 *database, const char *sql)
{
    program *all = calloc(1, sizeof *all);
    char *text = sqlite3_mprintf("EXPLAIN %s", sql);
    sqlite3_stmt *statement = NULL;
    int code = SQLITE_NOMEM;
    if (all && text) code = sqlite3_prepare_v2(database, text, -1, &statement, NULL);
    while (code == SQLITE_OK || code == SQLITE_ROW) {
        code = sqlite3_step(statement);
        if (code == SQLITE_ROW) add_instruction(all, statement);
    }
    sqlite3_finalize(statement);
    sqlite3_free(text);
    if (code == SQLITE_DONE) return all;
    free(all);
    return NULL;
}

static int64_t least(int64_t a, int64_t b) { return a < b ? a : b; }

int query_longest_text(sqlite3 *database, const char *sql)
{
    if (strlen(sql) < QUERY_SHORT_SQL) return QUERY_LONGEST_TEXT;
    program *all = read_program(database, sql);
    if (!all) return 0;
    const int64_t longest = least(COSTLY_BYTES / (all->costly + 1), REGISTER_BYTES / (all->registers + 1));
    free(all);
    return (int)least(longest, QUERY_LONGEST_TEXT);
}

int query_longest_stored_text(sqlite3 *database, const char *sql)
{
    program *all = read_program(database, sql);
    if (!all) return 0;
    const int64_t longest = all->makes_texts ? 0 : least(LONGEST_STORED, PLAIN_BYTES / (all->registers + 1));
    free(all);
    return (int)longest;
}
