/* A text into an array, as much of it as fits. */
#ifndef TEXT_COPY_H
#define TEXT_COPY_H

#include <stddef.h>

/* from: UTF-8, of which no character is cut, since JSON could not hold a part of one. NULL is as "". */
void text_copy(char *to, size_t size, const char *from);

#endif
