#pragma once

#include <memory>
#include <string>
#include <vector>

#include "generator.hpp"
#include "support/temporary_folder.hpp"

namespace idim::test {

/// A robot's models in C99, generated in memory, compiled by the C compiler of this build with all warnings as errors,
/// and loaded.
class c_library {
  public:
    /// Throws std::runtime_error with the compiler's message where a file does not compile.
    explicit c_library(const std::string& robot_file, bool derivatives = false);

    const generator::generated_model& generated() const { return generated_; }
    /// The folder of the sources.
    const std::filesystem::path& folder() const { return folder_.path(); }
    std::vector<std::string> sources() const;

    /// The function <robot>_<name>. Throws std::runtime_error where there is none.
    template <class Function>
    Function* function(const std::string& name) const {
        return reinterpret_cast<Function*>(symbol(name));
    }
    bool has(const std::string& name) const;

  private:
    void* symbol(const std::string& name) const;

    generator::generated_model generated_;
    temporary_folder folder_;
    std::shared_ptr<void> library_;
};

/// What firmware would be compiled with, and more.
const std::vector<std::string>& strict_c_options();

}  // namespace idim::test
