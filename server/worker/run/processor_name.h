/* What the processor calls itself, as "AMD EPYC 7763 64-Core Processor": runs on one type of it are as fast as each other. */
#ifndef PROCESSOR_NAME_H
#define PROCESSOR_NAME_H

/* "unknown": it does not say. The text lives as long as the program. */
const char *processor_name(void);

#endif
