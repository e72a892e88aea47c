/* `reposed check`: whether the database and the folders of jobs are sound and fit each other, and mending what is not. */
#ifndef DATA_CHECK_H
#define DATA_CHECK_H

#include <stdbool.h>

/* Prints a line a finding and one that counts them. Only looking does no harm beside a daemon at work; what that changes meanwhile
 * is not looked at. repair: of a folder that no daemon uses; nothing is removed but rows without a file: what is damaged, or is
 * nobody's, is put into DATA/lost. True: all is sound, or is now. */
bool data_check(const char *path, bool repair);

#endif
