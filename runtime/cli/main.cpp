#include <fmt/format.h>
#include <malloc.h>

#include <cstdio>
#include <exception>

#include "command.hpp"
#include "idim/input_error.hpp"

namespace {

/// A message is one line, whatever it quotes.
void complain(const std::string& message) {
    std::string line = message;
    for (char& c : line) {
        c = c == '\n' || c == '\r' ? ' ' : c;
    }
    fmt::print(stderr, "idim: {}\n", line);
}

int run(const idim::cli::action& chosen) {
    using namespace idim::cli;
    try {
        return chosen();
    } catch (const idim::input_error& error) {
        complain(error.what());
        return exit_bad_input;
    } catch (const idim::data_error& error) {
        complain(error.what());
        return exit_data_cannot_answer;
    } catch (const std::exception& error) {
        complain(error.what());
        return exit_check_said_no;
    }
}

}  // namespace

int main(int argc, char** argv) {
    using namespace idim::cli;
    // Models are many small objects, data are matrices of some megabytes, and both come and go: memory is taken from
    // the system in few pieces and kept instead of given back every time, which costs more than what is computed with
    // them.
    constexpr int kept_bytes = 1 << 26;
    mallopt(M_TOP_PAD, 1 << 22);
    mallopt(M_MMAP_THRESHOLD, kept_bytes / 2);
    mallopt(M_TRIM_THRESHOLD, kept_bytes);
    CLI::App app("idim " IDIM_VERSION ": symbolic robot models, generated code, identification", "idim");
    app.set_version_flag("--version", IDIM_VERSION);
    app.require_subcommand(1);
    action chosen;
    add_base_command(app, chosen);
    add_generate_command(app, chosen);
    add_diff_command(app, chosen);
    add_excite_command(app, chosen);
    add_simulate_command(app, chosen);
    add_identify_command(app, chosen);
    add_validate_command(app, chosen);
    add_diagnose_command(app, chosen);
    add_refine_command(app, chosen);
    add_export_command(app, chosen);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked) {
        return app.exit(asked);
    } catch (const CLI::ParseError& error) {
        complain(std::string(error.what()) + " (see idim --help)");
        return exit_bad_input;
    }
    return run(chosen);
}
