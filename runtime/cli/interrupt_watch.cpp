#include "interrupt_watch.hpp"

#include <ctime>

namespace idim::cli {

namespace {

volatile std::sig_atomic_t is_interrupted = 0;
volatile std::time_t first_interrupt = 0;

/// What comes within a second or two is the same interrupt: a process and its group may each be sent it.
void note_interrupt(int signal) {
    if (is_interrupted == 0) {
        is_interrupted = 1;
        first_interrupt = std::time(nullptr);
    } else if (std::time(nullptr) > first_interrupt + 1) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

}  // namespace

interrupt_watch::interrupt_watch() {
    struct sigaction noted {};
    noted.sa_handler = note_interrupt;
    sigaction(SIGINT, &noted, &before_);
}

interrupt_watch::~interrupt_watch() {
    sigaction(SIGINT, &before_, nullptr);
}

bool interrupt_watch::interrupted() {
    return is_interrupted != 0;
}

}  // namespace idim::cli
