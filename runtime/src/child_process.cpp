#include "child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "file_descriptor.hpp"

namespace idim {

namespace {

/// What becomes of the child's standard streams.
class stream_actions {
  public:
    // The copies come first: `output` may itself be number 0 in a program started without standard input.
    explicit stream_actions(const file_descriptor& output) {
        int error = posix_spawn_file_actions_init(&actions_);
        if (error == 0) {
            error = posix_spawn_file_actions_adddup2(&actions_, output.number(), STDOUT_FILENO);
        }
        if (error == 0) {
            error = posix_spawn_file_actions_adddup2(&actions_, output.number(), STDERR_FILENO);
        }
        if (error == 0) {
            error = posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        }
        if (error != 0) {
            throw std::system_error(error, std::generic_category(), "cannot prepare a child process");
        }
    }
    ~stream_actions() { posix_spawn_file_actions_destroy(&actions_); }
    stream_actions(const stream_actions&) = delete;
    stream_actions& operator=(const stream_actions&) = delete;

    const posix_spawn_file_actions_t* get() const { return &actions_; }

  private:
    posix_spawn_file_actions_t actions_;
};

int wait_for(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) {
            throw std::runtime_error("lost a child process: " + std::generic_category().message(errno));
        }
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

child_result run_child(const std::vector<std::string>& command) {
    std::vector<std::string> words = command;
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    const file_descriptor output = memory_file();
    const stream_actions actions(output);
    pid_t child = 0;
    const int error = posix_spawn(&child, arguments[0], actions.get(), nullptr, arguments.data(), environ);
    if (error != 0) {
        throw std::runtime_error("cannot run " + command.front() + ": " + std::generic_category().message(error));
    }
    const int exit_status = wait_for(child);
    return {exit_status, read_all(output)};
}

}  // namespace idim
