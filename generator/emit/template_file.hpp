#pragma once

#include <initializer_list>
#include <kainjow/mustache.hpp>
#include <string>
#include <vector>

#include "emit/context_data.hpp"

namespace idim::generator {

/// Names of the templates of a folder without .mustache, in alphabetical order.
struct template_names {
    explicit template_names(const std::string& folder);

    std::vector<std::string> files;     ///< "function.hpp"
    std::vector<std::string> partials;  ///< "preamble": without another ending
};

/// Text of a template. Throws std::runtime_error where it cannot be read.
std::string read_template(const std::string& folder, const std::string& name);

/// A template of files, parsed once and filled any number of times.
class template_file {
  public:
    /// Throws std::runtime_error where the template cannot be read or is malformed.
    template_file(const std::string& folder, const std::string& name);

    /// The text with the values of some contexts, of which a later one stands before an earlier one. Throws
    /// std::runtime_error where the template names a key that none of them has.
    std::string filled(std::initializer_list<const context_data*> contexts);

  private:
    std::string name_;
    std::vector<std::string> keys_;
    kainjow::mustache::mustache content_;
};

}  // namespace idim::generator
