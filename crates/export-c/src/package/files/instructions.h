/* Counts of instructions on an emulated board. */
#ifndef INSTRUCTIONS_H
#define INSTRUCTIONS_H

#include <stddef.h>

/* Starts the timer, and prints the count of a loop of known length. */
void count_start(void);

/* Stand before and after a call of the function with this index. */
void count_begin(void);
void count_end(size_t function);

/* Says whence the inputs of the next calls are. */
enum { COUNT_RUN, COUNT_RANDOM, COUNT_EXTREME, COUNT_SOURCES };
void count_inputs(int from);

/* Prints the largest counts of each function. */
void count_print(const char *const *names, size_t functions);

#endif
