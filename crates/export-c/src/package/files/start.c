/* Start of a program on a Cortex-M board: vectors, floating-point unit, zeroed memory, and main. */

#include <stdint.h>
#include <stdlib.h>

extern int main(int argc, char **argv);
extern void initialise_monitor_handles(void);
extern char stack_top;
extern char bss_start;
extern char bss_end;

void start(void);

__attribute__((section(".vectors"), used)) static const uintptr_t vectors[2] = { (uintptr_t)&stack_top, (uintptr_t)&start };

void start(void)
{
    /* Coprocessors 10 and 11 are the floating-point unit. */
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20;
    __asm volatile("dsb\n\tisb");
    for (char *byte = &bss_start; byte < &bss_end; ++byte) {
        *byte = 0;
    }
    initialise_monitor_handles();
    exit(main(0, NULL));
}
