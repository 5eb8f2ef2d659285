#pragma once

#include <csignal>

namespace idim::cli {

/// While it lives the first interrupt (SIGINT) is noted and not obeyed, so that a long command can stop with the best
/// it has; a later one ends the command.
class interrupt_watch {
  public:
    interrupt_watch();
    ~interrupt_watch();
    interrupt_watch(const interrupt_watch&) = delete;
    interrupt_watch& operator=(const interrupt_watch&) = delete;

    static bool interrupted();

  private:
    struct sigaction before_ {};
};

}  // namespace idim::cli
