#include "support/command.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

#include "support/robot_files.hpp"
#include "support/temporary_folder.hpp"

namespace idim::test {

namespace {

/// In the child: both streams to files, then the command. Does not return.
[[noreturn]] void become(const std::vector<char*>& words, const std::string& out, const std::string& err) {
    const int out_file = open(out.c_str(), O_WRONLY | O_CREAT, 0600);
    const int err_file = open(err.c_str(), O_WRONLY | O_CREAT, 0600);
    dup2(out_file, STDOUT_FILENO);
    dup2(err_file, STDERR_FILENO);
    execvp(words[0], words.data());
    _exit(127);
}

}  // namespace

command_result run_program(std::vector<std::string> texts) {
    const temporary_folder folder;
    const std::string out = (folder.path() / "out").string();
    const std::string err = (folder.path() / "err").string();
    std::vector<char*> words;
    for (std::string& text : texts) {
        words.push_back(text.data());
    }
    words.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) {
        throw std::runtime_error("cannot start a process");
    }
    if (child == 0) {
        become(words, out, err);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

command_result run_idim(const std::vector<std::string>& arguments) {
    std::vector<std::string> words = {IDIM_COMMAND};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_program(words);
}

}  // namespace idim::test
