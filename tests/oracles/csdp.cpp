#include "oracles/csdp.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "support/temporary_folder.hpp"

namespace idim::test {

namespace {

/// The sparse SDPA format [Borchers 1999]: minimise c'y with sum of y_k F_k - F_0 >= 0, blocks of matrices, upper
/// triangles. Variables are x, then t; entry "k block row column value", k = 0 for F_0.
class sdpa_problem {
  public:
    /// A and b times `scale`.
    sdpa_problem(const cone_program& program, double scale) {
        const Eigen::Index variables = program.A.cols() + 1;
        const Eigen::Index rows = program.A.rows();
        for (const matrix_constraint& constraint : program.matrices) {
            sizes_.push_back(static_cast<int>(constraint.reference.rows()));
            const Eigen::Index size = constraint.reference.rows();
            for (std::size_t k = 0; k < constraint.places.size(); ++k) {
                add(constraint.places[k] + 1, constraint.basis[k]);
            }
            add(0, constraint.floor * Eigen::MatrixXd::Identity(size, size));
        }
        sizes_.push_back(-static_cast<int>(program.bounds.size()));
        for (std::size_t i = 0; i < program.bounds.size(); ++i) {
            for (const linear_constraint::term& term : program.bounds[i].terms) {
                entry(term.place + 1, i + 1, i + 1, term.factor);
            }
            entry(0, i + 1, i + 1, program.bounds[i].low);
        }
        sizes_.push_back(static_cast<int>(rows) + 1);
        const auto last = static_cast<std::size_t>(rows) + 1;
        for (Eigen::Index r = 0; r < rows; ++r) {
            const auto row = static_cast<std::size_t>(r) + 1;
            entry(0, row, row, -1.0);
            entry(0, row, last, scale * program.b[r]);
            for (Eigen::Index k = 0; k < program.A.cols(); ++k) {
                entry(k + 1, row, last, scale * program.A(r, k));
            }
        }
        entry(variables, last, last, 2.0);
        header_ = fmt::format("{}\n{}\n{}\n", variables, sizes_.size(), fmt::join(sizes_, " "));
        for (Eigen::Index k = 0; k < program.A.cols(); ++k) {
            header_ += "0 ";
        }
        header_ += "1\n";
    }

    std::string text() const { return header_ + entries_; }

  private:
    void entry(Eigen::Index k, std::size_t row, std::size_t column, double value) {
        if (value != 0.0) {
            entries_ += fmt::format("{} {} {} {} {:.17g}\n", k, sizes_.size(), row, column, value);
        }
    }
    void add(Eigen::Index k, const Eigen::MatrixXd& F) {
        for (Eigen::Index c = 0; c < F.cols(); ++c) {
            for (Eigen::Index r = 0; r <= c; ++r) {
                entry(k, static_cast<std::size_t>(r) + 1, static_cast<std::size_t>(c) + 1, F(r, c));
            }
        }
    }

    std::vector<int> sizes_;
    std::string header_, entries_;
};

}  // namespace

std::optional<csdp_optimum> solve_with_csdp(const cone_program& program, double size) {
    const temporary_folder folder;
    const double scale = 1.0 / std::sqrt(size);
    const std::string problem = folder.write("problem.dat-s", sdpa_problem(program, scale).text());
    const std::string solution = (folder.path() / "solution").string();
    const int status =
        std::system(fmt::format("csdp {} {} > {}", problem, solution, (folder.path() / "log").string()).c_str());
    std::ifstream file(solution);
    if (status == -1 || !file) {
        return std::nullopt;
    }
    csdp_optimum optimum;
    optimum.x.resize(program.A.cols());
    for (double& value : optimum.x) {
        file >> value;
    }
    double t = 0.0;
    file >> t;
    optimum.objective = program.constant + t / (scale * scale);
    return file ? std::optional(optimum) : std::nullopt;
}

}  // namespace idim::test
