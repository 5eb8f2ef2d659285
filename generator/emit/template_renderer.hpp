#pragma once

#include <string>
#include <vector>

#include "backend/template_context.hpp"

namespace idim::generator {

struct rendered_file {
    std::string name;  ///< relative to the model's folder
    std::string text;
};

/// Fills the templates of a target's folder (templates/cpp), in alphabetical order. What a file is called and how often
/// it is written follows from the name of its template, `<stem>.<extension>.mustache`:
///   function  a file for each model and scalar type, called after both (inverse_dynamics_f.c)
///   robot     a file called after the robot
///   others    a file of that name
/// Files without an extension of their own (preamble.mustache) are what the others include by {{>preamble}}.
/// Throws std::runtime_error for a folder or template that cannot be read, is malformed, or names a key that the
/// context does not have.
std::vector<rendered_file> render(const template_context& context, const std::string& folder);

}  // namespace idim::generator
