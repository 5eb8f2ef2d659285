#include "board.h"

#include <stddef.h>

extern uint32_t bss_end[];

/* Operations of Arm's semihosting (Semihosting for AArch32 and AArch64, release 2.0, section 6). */
enum semihosting_operation { semihosting_write0 = 0x04, semihosting_exit_extended = 0x20 };

static void semihosting(enum semihosting_operation operation, const void* argument) {
    register uint32_t r0 __asm__("r0") = (uint32_t)operation;
    register const void* r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

void write_text(const char* text) {
    semihosting(semihosting_write0, text);
}

void stop(int status) {
    const uint32_t application_exit = 0x20026;
    const uint32_t block[2] = {application_exit, (uint32_t)status};
    semihosting(semihosting_exit_extended, block);
    for (;;) {
    }
}

/* SysTick (Armv7-M Architecture Reference Manual, B3.3). */
static volatile uint32_t* const systick_control = (volatile uint32_t*)0xE000E010;
static volatile uint32_t* const systick_reload = (volatile uint32_t*)0xE000E014;
static volatile uint32_t* const systick_value = (volatile uint32_t*)0xE000E018;

void start_counter(void) {
    const uint32_t enable = 1U, processor_clock = 4U;
    *systick_reload = 0xFFFFFFU;
    *systick_value = 0;
    *systick_control = enable | processor_clock;
}

uint32_t read_counter(void) {
    return *systick_value;
}

static const uint32_t pattern = 0xA5A5A5A5U;

void paint_stack(void) {
    for (volatile uint32_t* word = bss_end; word < (uint32_t*)__builtin_frame_address(0); ++word) {
        *word = pattern;
    }
}

uintptr_t deepest_stack(void) {
    const volatile uint32_t* word = bss_end;
    while (*word == pattern) {
        ++word;
    }
    return (uintptr_t)word;
}
