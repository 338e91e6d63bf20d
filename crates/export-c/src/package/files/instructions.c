/* Counts the instructions of the driver's calls on an emulated board.
 *
 * With `-icount shift=10` the time of QEMU goes on by 1024 ns with each instruction and by nothing else. The timer of the board
 * counts it down at 25 MHz. These are instructions, not cycles of a real board.
 */

#include "instructions.h"

#include <stdint.h>
#include <stdio.h>

/* Registers of the timer 0: control, value, reload. */
#define TIMER ((volatile uint32_t *)0x40000000u)
/* Ticks of 40 ns in ten instructions. */
#define TICKS_OF_TEN 256u
enum { MOST_FUNCTIONS = 8, TURNS = 1000 };

static uint32_t began;
static uint32_t overhead;
static uint32_t worst[COUNT_SOURCES][MOST_FUNCTIONS];
static int source;

__attribute__((noinline)) void count_begin(void)
{
    began = TIMER[1];
}

__attribute__((noinline)) void count_end(size_t function)
{
    const uint64_t ticks = began - TIMER[1];
    const uint32_t count = (uint32_t)((ticks * 10u + TICKS_OF_TEN / 2u) / TICKS_OF_TEN) - overhead;
    if (function < MOST_FUNCTIONS && count > worst[source][function]) {
        worst[source][function] = count;
    }
}

/* Returns the count of a loop of two instructions. */
static uint32_t count_of_loop(uint32_t turns)
{
    worst[source][0] = 0;
    count_begin();
    __asm volatile("1: subs %0, %0, #1\n\tbne 1b" : "+r"(turns) : : "cc");
    count_end(0);
    return worst[source][0];
}

void count_start(void)
{
    TIMER[2] = 0xffffffffu;
    TIMER[1] = 0xffffffffu;
    TIMER[0] = 1u;
    overhead = 0;
    count_begin();
    count_end(0);
    overhead = worst[source][0];
    const uint32_t known = count_of_loop(2 * TURNS) - count_of_loop(TURNS);
    worst[source][0] = 0;
    printf("a loop of %lu instructions: %lu counted\n", (unsigned long)(2 * TURNS), (unsigned long)known);
}

void count_inputs(int from)
{
    source = from;
}

void count_print(const char *const *names, size_t functions)
{
    for (size_t function = 0; function < functions && function < MOST_FUNCTIONS; ++function) {
        printf("%s: at most %lu instructions in the run, %lu with random inputs, %lu with extreme ones\n", names[function],
            (unsigned long)worst[COUNT_RUN][function], (unsigned long)worst[COUNT_RANDOM][function],
            (unsigned long)worst[COUNT_EXTREME][function]);
    }
}
