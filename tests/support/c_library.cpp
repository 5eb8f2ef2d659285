#include "support/c_library.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include "support/command.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

const std::vector<std::string>& strict_c_options() {
    static const std::vector<std::string> options = {"-std=c99",
                                                     "-pedantic",
                                                     "-Wall",
                                                     "-Wextra",
                                                     "-Wshadow",
                                                     "-Wconversion",
                                                     "-Wdouble-promotion",
                                                     "-Wfloat-conversion",
                                                     "-Wundef",
                                                     "-Werror",
                                                     "-Wmissing-prototypes"};
    return options;
}

std::vector<std::string> c_library::sources() const {
    std::vector<std::string> names;
    for (const generator::rendered_file& file : generated_.files) {
        if (std::filesystem::path(file.name).extension() == ".c") {
            names.push_back((folder() / file.name).string());
        }
    }
    return names;
}

c_library::c_library(const std::string& robot_file, bool derivatives)
    : generated_(generator::generate(robot_file, templates_folder, {"c", "ops", derivatives})) {
    for (const generator::rendered_file& file : generated_.files) {
        folder_.write(file.name, file.text);
    }
    const std::string library = (folder() / "models.so").string();
    std::vector<std::string> command = {IDIM_C_COMPILER, "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-o", library};
    command.insert(command.end(), strict_c_options().begin(), strict_c_options().end());
    const std::vector<std::string> files = sources();
    command.insert(command.end(), files.begin(), files.end());
    command.emplace_back("-lm");
    const command_result result = run_program(command);
    if (result.status != 0) {
        throw std::runtime_error(result.err);
    }
    library_.reset(dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL), [](void* handle) {
        if (handle != nullptr) {
            dlclose(handle);
        }
    });
    if (!library_) {
        throw std::runtime_error(dlerror());
    }
}

bool c_library::has(const std::string& name) const {
    return dlsym(library_.get(), (generated_.robot + "_" + name).c_str()) != nullptr;
}

void* c_library::symbol(const std::string& name) const {
    void* const found = dlsym(library_.get(), (generated_.robot + "_" + name).c_str());
    if (found == nullptr) {
        throw std::runtime_error("no function " + name);
    }
    return found;
}

}  // namespace idim::test
