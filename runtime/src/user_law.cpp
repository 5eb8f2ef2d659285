#include "idim/user_law.hpp"

#include <sstream>
#include <stdexcept>
#include <utility>

#include "idim/input_error.hpp"

namespace idim {

namespace {

const idim_law_table& table_of(const std::shared_ptr<const compiled_law>& code) {
    return code->table();
}

/// From the header's name on, of the first line of a compiler's message that tells an error; all of it where none does.
std::string first_error(const std::string& message, const std::string& header) {
    std::istringstream lines(message);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("error:") != std::string::npos) {
            const std::size_t name = line.find(header + ":");
            return name == std::string::npos ? line : line.substr(name);
        }
    }
    return message;
}

}  // namespace

user_law::user_law(std::shared_ptr<const compiled_law> code, std::vector<Eigen::VectorXd> values)
    : code_(std::move(code)), values_(std::move(values)), law_(table_of(code_).create(), table_of(code_).destroy) {}

user_law::user_law(const user_law& other)
    : control_law(other),
      code_(other.code_),
      values_(other.values_),
      law_(table_of(code_).copy(other.law_.get()), table_of(code_).destroy) {}

Eigen::VectorXd user_law::unlimited(const control_sample& sample) {
    std::vector<const double*> values;
    for (const Eigen::VectorXd& value : values_) {
        values.push_back(value.data());
    }
    const Eigen::Index n = sample.q.size();
    const idim_law_sample known = {static_cast<int>(n), sample.t,          1.0 / rate,
                                   sample.qr.data(),    sample.qdr.data(), sample.qddr.data(),
                                   sample.q.data(),     sample.qd.data(),  values.data()};
    Eigen::VectorXd v = Eigen::VectorXd::Zero(n);
    table_of(code_).command(law_.get(), &known, v.data());
    return v;
}

void user_law::limited(const Eigen::VectorXd& wanted, const Eigen::VectorXd& given) {
    table_of(code_).limited(law_.get(), wanted.data(), given.data());
}

void user_law::forget() {
    law_ = memory(table_of(code_).create(), table_of(code_).destroy);
}

compiled_law compile_user_law(const model_source& header, const std::vector<model_source>& interface,
                              const input_location& where, const compile_options& options) {
    std::vector<model_source> sources = interface;
    sources.push_back(header);
    sources.push_back({"idim_law.cpp", "#include \"" + header.name +
                                           "\"\n\n#include \"idim/law_adapter.hpp\"\n\n"
                                           "extern \"C\" const idim_law_table* idim_law() {\n"
                                           "    return idim::law_adapter<control_law>::table();\n}\n"});
    try {
        return compile_law(sources, options);
    } catch (const std::runtime_error& error) {
        throw input_error(where, header.name +
                                     " cannot be compiled, expected a header that defines struct control_law "
                                     "(idim/law_interface.h): " +
                                     first_error(error.what(), header.name));
    }
}

}  // namespace idim
