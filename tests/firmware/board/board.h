/* What the firmware needs of the board: text out, an end, and two measurements. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Text to the debugger's console, by semihosting. */
void write_text(const char* text);

/* Ends the run with this exit status. */
__attribute__((noreturn)) void stop(int status);

/* Starts SysTick, which counts down from 2^24 - 1 at the processor's clock of 25 MHz. */
void start_counter(void);

/* Its count now. QEMU with -icount shift=0 takes 1 ns for each instruction, so one count is 40 instructions. */
uint32_t read_counter(void);

/* Fills the stack below the caller with a pattern. */
void paint_stack(void);

/* Address of the lowest word below which the pattern still stands. */
uintptr_t deepest_stack(void);

#ifdef __cplusplus
}
#endif

#endif
