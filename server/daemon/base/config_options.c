#include "config_options.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job_resources.h"
#include "subscriber.h"

/* "http[s]://host[:port][/prefix]"; it goes into addresses as it is. */
static bool take_public_url(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    static const char path[] = "/abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~", *letters = path + 1;
    const char *host = strncmp(value, "https://", 8) == 0 ? value + 8 : strncmp(value, "http://", 7) == 0 ? value + 7 : NULL;
    size_t length = strlen(value);
    while (host && length > 0 && value[length - 1] == '/') length--;
    const size_t name = host ? (*host == '[' ? strcspn(host, "]") + 1 : strspn(host, letters)) : 0;
    const char *rest = host && name > 0 && name < sizeof settings->public_host ? host + name : "?";
    if (*rest == ':') rest += 1 + strspn(rest + 1, "0123456789");
    const bool good = (*rest == '\0' || *rest == '/') && rest[strspn(rest, path)] == '\0' && !strstr(rest, "//")
                      && !strstr(rest, "/.") && length < sizeof settings->public_url_kept;
    if (!good) {
        snprintf(problem, OPTION_PROBLEM_SIZE, "http:// or https:// with a host and perhaps a port and a path");
        return false;
    }
    snprintf(settings->public_url_kept, sizeof settings->public_url_kept, "%.*s", (int)length, value);
    const bool six = *host == '[';
    snprintf(settings->public_host, sizeof settings->public_host, "%.*s", (int)(six ? name - 2 : name), host + six);
    settings->public_url = settings->public_url_kept;
    return true;
}

static bool take_host_name(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    if (settings->allowed_hosts == CONFIG_HOSTS) {
        snprintf(problem, OPTION_PROBLEM_SIZE, "one of %d names at most", CONFIG_HOSTS);
        return false;
    }
    settings->allowed_host[settings->allowed_hosts++] = value;
    return true;
}

static bool take_origin(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    const char *host = strncmp(value, "https://", 8) == 0 ? value + 8 : strncmp(value, "http://", 7) == 0 ? value + 7 : "";
    const bool good = *host && !strpbrk(host, "/ ,*?#@") && settings->allowed_origins < CONFIG_HOSTS;
    snprintf(problem, OPTION_PROBLEM_SIZE, "one of %d at most, as https://host:port without a path", CONFIG_HOSTS);
    if (good) settings->allowed_origin[settings->allowed_origins++] = value;
    return good;
}

static bool take_callback_host(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    const bool good = callback_host_is_good(value) && settings->callback_hosts < CONFIG_HOSTS;
    snprintf(problem, OPTION_PROBLEM_SIZE, "one of %d at most, a name or address, perhaps with :port", CONFIG_HOSTS);
    if (good) settings->callback_host[settings->callback_hosts++] = value;
    return good;
}

static bool take_confine(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    settings->confine = strcmp(value, "yes") == 0;
    snprintf(problem, OPTION_PROBLEM_SIZE, "yes or no");
    return settings->confine || strcmp(value, "no") == 0;
}

static bool take_executor(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    settings->on_slurm = strcmp(value, "slurm") == 0;
    snprintf(problem, OPTION_PROBLEM_SIZE, "local or slurm");
    return settings->on_slurm || strcmp(value, "local") == 0;
}

static bool take_slurm_line(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    const bool good = strncmp(value, "--", 2) == 0 && strlen(value) < 250 && settings->slurm_lines < CONFIG_HOSTS;
    snprintf(problem, OPTION_PROBLEM_SIZE, "one of %d at most, a long option of sbatch as --reservation=drums", CONFIG_HOSTS);
    if (good) settings->slurm_line[settings->slurm_lines++] = value;
    return good;
}

static bool take_slurm_allowance(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    const bool good = resource_entry_is_good(value) && settings->slurm_allowances < CONFIG_HOSTS;
    char names[RESOURCES_SIZE];
    snprintf(problem, OPTION_PROBLEM_SIZE, "one of %d at most, as partition=cpu,gpu; of %s", CONFIG_HOSTS, resource_names(names));
    if (good) settings->slurm_allowed[settings->slurm_allowances++] = value;
    return good;
}

static bool take_log_format(config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    settings->log_json = strcmp(value, "json") == 0;
    snprintf(problem, OPTION_PROBLEM_SIZE, "text or json");
    return settings->log_json || strcmp(value, "text") == 0;
}

static bool is_same_text(const char *one, const char *other) { return one && other ? strcmp(one, other) == 0 : one == other; }

static bool has_same_url(const config *one, const config *other) { return is_same_text(one->public_url, other->public_url); }
static bool confines_alike(const config *one, const config *other) { return one->confine == other->confine; }
static bool execute_alike(const config *one, const config *other) { return one->on_slurm == other->on_slurm; }
static bool logs_alike(const config *one, const config *other) { return one->log_json == other->log_json; }

static bool is_same_list(const char *const *one, int count, const char *const *other, int others)
{
    bool same = count == others;
    for (int i = 0; same && i < count; i++) same = strcmp(one[i], other[i]) == 0;
    return same;
}

static bool allows_same_hosts(const config *one, const config *other)
{
    return is_same_list(one->allowed_host, one->allowed_hosts, other->allowed_host, other->allowed_hosts);
}

static bool allows_same_origins(const config *one, const config *other)
{
    return is_same_list(one->allowed_origin, one->allowed_origins, other->allowed_origin, other->allowed_origins);
}

static bool calls_same_hosts(const config *one, const config *other)
{
    return is_same_list(one->callback_host, one->callback_hosts, other->callback_host, other->callback_hosts);
}

static bool has_same_slurm_lines(const config *one, const config *other)
{
    return is_same_list(one->slurm_line, one->slurm_lines, other->slurm_line, other->slurm_lines);
}

static bool has_same_slurm_allowances(const config *one, const config *other)
{
    return is_same_list(one->slurm_allowed, one->slurm_allowances, other->slurm_allowed, other->slurm_allowances);
}

#define LIVE .is_live = true
#define AT(member) .offset = offsetof(config, member)
#define WHOLE(member, least, most) .kind = OPTION_WHOLE, AT(member), .low = least, .high = most
#define AMOUNT(member, least, most) .kind = OPTION_AMOUNT, AT(member), .low = least, .high = most
#define FLAG(member) .kind = OPTION_FLAG, AT(member)
#define TEXT(member) .kind = OPTION_TEXT, AT(member)

const config_option config_options[] = {
    { "config", "FILE", "a file of these options, a line each: port = 8080\n(/etc/reposed.conf where it was installed)",
      TEXT(file) },
    { "host", "ADDRESS", "where to listen (127.0.0.1); beyond loopback needs --token-file", TEXT(host) },
    { "port", "NUMBER", "0 to 65535 (8080); 0 takes any free port and prints it", WHOLE(port, 0, 65535) },
    { "data", "DIR", "database and job folders, made when missing (./data)", TEXT(data) },
    { "workers", "N", "jobs at once, 1 to 256 (one for each core)", WHOLE(workers, 1, CONFIG_MOST_WORKERS) },
    { "threads", "N", "threads of a job that does not ask, 1 to 256 (1)", WHOLE(threads, 1, 256), LIVE },
    { "queue-limit", "N", "jobs that may wait, 1 to 1000000 (10000); a study that makes more is refused",
      WHOLE(queue_limit, 1, 1000000), LIVE },
    { "keep-days", "N", "delete jobs so long after their end, 1 to 100000 (never); pinned ones stay", WHOLE(keep_days, 1, 100000),
      LIVE },
    { "keep-bytes", "SIZE", "what the folders of jobs may take, as 500G (anything): the oldest snapshots go first,\nresults last",
      AMOUNT(keep_bytes, 1e6, 1e18), LIVE },
    { "max-estimate-seconds", "S", "what one POST may take by its estimate, at least 1 (anything)",
      AMOUNT(max_estimate_seconds, 1.0, 1e12), LIVE },
    { "max-particles", "N", "particles of one job, at least 1 (anything)", AMOUNT(max_particles, 1.0, 1e9), LIVE },
    { "max-snapshot-bytes", "SIZE", "what the snapshots of one POST may take, as 20G (anything)",
      AMOUNT(max_snapshot_bytes, 1.0, 1e18), LIVE },
    { "max-threads", "N", "threads of one job, 1 to 256 (256)", WHOLE(max_threads, 1, 256), LIVE },
    { "log", "FORMAT", "text or json: lines of the log (text)", .kind = OPTION_TAKEN, .take = take_log_format,
      .is_same = logs_alike, LIVE },
    { "token-file", "FILE",
      "clients must send \"Authorization: Bearer\" with a token of it, a line each: NAME read|write TOKEN;\nmode 0600; read again "
      "on SIGHUP",
      TEXT(token_file), LIVE },
    { "address-rate", "N", "requests a second of one address, 1 to 1000000 (2000)", WHOLE(address_rate, 1, 1000000), LIVE },
    { "allow-host", "NAME", "accept this name in the Host header; may be given 8 times", .kind = OPTION_TAKEN, .may_repeat = true,
      .take = take_host_name, .is_same = allows_same_hosts, LIVE },
    { "allow-origin", "ORIGIN", "let pages of https://host:port use the service; may be given 8 times", .kind = OPTION_TAKEN,
      .may_repeat = true, .take = take_origin, .is_same = allows_same_origins, LIVE },
    { "callback-host", "NAME[:PORT]", "let jobs have this host called back; may be given 8 times (none)", .kind = OPTION_TAKEN,
      .may_repeat = true, .take = take_callback_host, .is_same = calls_same_hosts },
    { "public-url", "URL", "what addresses begin with for clients, as https://host/prefix behind a proxy", .kind = OPTION_TAKEN,
      .take = take_public_url, .is_same = has_same_url, LIVE },
    { "port-file", "FILE", "write the port there once it is open", TEXT(port_file) },
    { "worker", "PATH", "the worker program (repose, beside this one)", TEXT(worker) },
    { "confine", "yes|no", "let a worker use its job folder alone, no network and no programs (yes)", .kind = OPTION_TAKEN,
      AT(confine), .take = take_confine, .is_same = confines_alike },
    { "executor", "local|slurm", "where workers run: on this machine, or in jobs of Slurm (local)", .kind = OPTION_TAKEN,
      AT(on_slurm), .take = take_executor, .is_same = execute_alike },
    { "slurm-queue", "N", "most jobs of ours in Slurm's queue, 1 to 100000 (200)", WHOLE(slurm_queue, 1, 100000) },
    { "bundle-seconds", "S",
      "short jobs run one after the other in one job of Slurm, until they are expected to take\nso long, 0 to 86400 (300); 0: none",
      WHOLE(slurm_bundle_seconds, 0, 86400) },
    { "slurm-longest", "S", "what one job of Slurm is given at most, at least 180 (86400); what takes longer goes on in another",
      AMOUNT(slurm_longest, 180.0, 1e8) },
    { "slurm-partition", "NAME", "the partition of Slurm's that is asked for", TEXT(slurm_partition) },
    { "slurm-account", "NAME", "the account that is charged", TEXT(slurm_account) },
    { "slurm-qos", "NAME", "the quality of service that is asked for", TEXT(slurm_qos) },
    { "slurm-constraint", "LIST", "features that a node must have", TEXT(slurm_constraint) },
    { "slurm-line", "OPTION", "another option of sbatch, which has the last word; may be given 8 times", .kind = OPTION_TAKEN,
      .may_repeat = true, .take = take_slurm_line, .is_same = has_same_slurm_lines },
    { "slurm-allow", "NAME=VALUE,...",
      "let the \"resources\" of a job choose among these, as partition=cpu,gpu; may be given 8 times", .kind = OPTION_TAKEN,
      .may_repeat = true, .take = take_slurm_allowance, .is_same = has_same_slurm_allowances, LIVE },
    { "web", "DIR", "the page (where it lies in the sources, or was installed)", TEXT(web) },
    { "api-file", "FILE", "the OpenAPI document (likewise)", TEXT(api_file) },
    { "wait", NULL, "of submit: until it has ended; 0 only where it is successful", FLAG(wait) },
    { "json", NULL, "of jobs and show: as the service sends it", FLAG(json) },
    { "dry-run", NULL, "of prune: remove nothing, say what would go", FLAG(dry_run) },
    { "repair", NULL, "of check, while no service is at work: what is damaged is put into DATA/lost", FLAG(repair) },
};
const size_t config_option_count = sizeof config_options / sizeof config_options[0];
_Static_assert(sizeof config_options / sizeof config_options[0] <= MOST_OPTIONS, "there is room for all");

const config_option *config_option_named(const char *name)
{
    for (size_t o = 0; o < config_option_count; o++)
        if (strcmp(config_options[o].name, name) == 0) return &config_options[o];
    return NULL;
}

static bool take_whole(const config_option *option, int *number, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    char *end;
    errno = 0;
    const long read = strtol(value, &end, 10);
    const bool good = errno == 0 && end != value && *end == '\0' && read >= option->low && read <= option->high;
    if (good) *number = (int)read;
    else snprintf(problem, OPTION_PROBLEM_SIZE, "a whole number in [%.0f, %.0f]", option->low, option->high);
    return good;
}

/* "1500", "1.5k": in units of 1000. */
static bool take_amount(const config_option *option, double *number, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    static const char letters[] = "kMGT";
    char *end;
    double amount = strtod(value, &end);
    const char *letter = end != value && *end ? strchr(letters, *end) : NULL;
    for (const char *l = letters; letter && l <= letter; l++) amount *= 1e3;
    const bool good = end != value && end[letter ? 1 : 0] == '\0' && amount >= option->low && amount <= option->high;
    if (good) *number = amount;
    else snprintf(problem, OPTION_PROBLEM_SIZE, "a number in [%g, %g], which may end in k, M, G or T", option->low, option->high);
    return good;
}

bool config_option_take(const config_option *option, config *settings, const char *value, char problem[OPTION_PROBLEM_SIZE])
{
    void *place = (char *)settings + option->offset;
    switch (option->kind) {
    case OPTION_WHOLE: return take_whole(option, place, value, problem);
    case OPTION_AMOUNT: return take_amount(option, place, value, problem);
    case OPTION_FLAG: *(bool *)place = true; return true;
    case OPTION_TAKEN: return option->take(settings, value, problem);
    case OPTION_TEXT: break;
    }
    *(const char **)place = value;
    snprintf(problem, OPTION_PROBLEM_SIZE, "given");
    return *value != '\0';
}

bool config_option_is_same(const config_option *option, const config *one, const config *other)
{
    const void *a = (const char *)one + option->offset, *b = (const char *)other + option->offset;
    switch (option->kind) {
    case OPTION_WHOLE: return *(const int *)a == *(const int *)b;
    case OPTION_AMOUNT: return *(const double *)a == *(const double *)b;
    case OPTION_TEXT: return is_same_text(*(const char *const *)a, *(const char *const *)b);
    case OPTION_TAKEN: return option->is_same(one, other);
    case OPTION_FLAG: break;
    }
    return true;
}

void config_option_text(const config_option *option, const config *settings, char *text, size_t size)
{
    const void *place = (const char *)settings + option->offset;
    const int whole = option->kind == OPTION_WHOLE ? *(const int *)place : 0;
    const double amount = option->kind == OPTION_AMOUNT ? *(const double *)place : whole;
    const char *given = option->kind == OPTION_TEXT ? *(const char *const *)place : option->kind == OPTION_TAKEN ? "another" : NULL;
    /* 0 below the least that may be given: it was not. */
    if (given) snprintf(text, size, "%s", given);
    else if (option->kind == OPTION_TEXT || amount < option->low) snprintf(text, size, "none");
    else snprintf(text, size, "%.15g", amount);
}
