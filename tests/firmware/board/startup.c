/* From reset to main: floating-point unit on, initialised data copied, the rest zeroed. */
#include "board.h"

extern uint32_t data_load[], data_begin[], data_end[], bss_begin[], bss_end[], stack_top[];

int main(void);
void reset(void);

static void fault(void) {
    write_text("fault\n");
    stop(1);
}

void reset(void) {
    volatile uint32_t* const coprocessor_access = (volatile uint32_t*)0xE000ED88;
    *coprocessor_access |= 0xFU << 20; /* full access to CP10 and CP11 */
    __asm__ volatile("dsb\n isb");
    for (uint32_t *from = data_load, *to = data_begin; to < data_end; ++from, ++to) {
        *to = *from;
    }
    for (uint32_t* to = bss_begin; to < bss_end; ++to) {
        *to = 0;
    }
    stop(main());
}

typedef void (*vector)(void);

/* Stack, reset, then NMI, hard fault, memory, bus and usage fault. */
__attribute__((section(".vectors"), used)) static const vector vectors[] = {
    (vector)stack_top, reset, fault, fault, fault, fault, fault,
};
