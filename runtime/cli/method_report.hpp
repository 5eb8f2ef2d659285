#pragma once

#include <vector>

#include "method_run.hpp"

namespace idim::cli {

/// "iterations", "loop" and "tests" of the JSON of identify.
json iterations_json(const estimate& fit, const loaded_robot& robot);
json loop_json(const method_result& result);
json tests_json(const method_result& result, const loaded_robot& robot);

/// Start, assumption, every iteration's errors and distances, and how the parameters went.
void print_iterations(const method_result& result, const loaded_robot& robot);

/// Tests of residual and instruments.
void print_tests(const method_result& result, const loaded_robot& robot);

/// One table of all methods: parameters with deviations, errors; and what kept a method from a result.
void print_comparison(const std::vector<method_result>& results, const loaded_robot& robot);
json comparison_json(const std::vector<method_result>& results, const loaded_robot& robot);

}  // namespace idim::cli
