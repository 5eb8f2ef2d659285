#include "structure_proposal.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "effect_evidence.hpp"

namespace idim {

namespace {

constexpr int most_terms = 3;
constexpr double least_share = 0.1;      ///< of the first term's gain: a smaller term is left out
constexpr double nearly_the_same = 0.9;  ///< correlation outside the model of terms that stand for each other
constexpr int halves = 50;
constexpr double stable_share = 0.6;  ///< of the halves in which a term is chosen
constexpr int blocks = 20;
constexpr double collinear = 1e-3;  ///< part of a term's norm that is left outside the model and the terms before it
constexpr std::uint64_t seed = 2;

/// A function of a signal, as it is written and as it is evaluated; {} stands for the signal.
struct signal_function {
    const char* text;
    std::function<double(double)> value;
    int power;  ///< of the signal's unit
};

double sign(double x) {
    return static_cast<double>(x > 0.0) - static_cast<double>(x < 0.0);
}

const std::vector<signal_function>& functions_of(signal_source::kind what) {
    static const std::vector<signal_function> positions = {
        {"{}", [](double x) { return x; }, 1},
        {"{}^2", [](double x) { return x * x; }, 2},
        {"{}^3", [](double x) { return x * x * x; }, 3},
        {"cos({})", [](double x) { return std::cos(x); }, 0},
        {"sin({})", [](double x) { return std::sin(x); }, 0},
        {"cos(2*{})", [](double x) { return std::cos(2.0 * x); }, 0},
        {"sin(2*{})", [](double x) { return std::sin(2.0 * x); }, 0},
        {"cos(3*{})", [](double x) { return std::cos(3.0 * x); }, 0},
        {"sin(3*{})", [](double x) { return std::sin(3.0 * x); }, 0},
    };
    static const std::vector<signal_function> others = {
        {"{}", [](double x) { return x; }, 1},
        {"abs({})", [](double x) { return std::abs(x); }, 1},
        {"sign({})", sign, 0},
        {"{}^2", [](double x) { return x * x; }, 2},
        {"{}*abs({})", [](double x) { return x * std::abs(x); }, 2},
        {"{}^3", [](double x) { return x * x * x; }, 3},
    };
    return what == signal_source::kind::q ? positions : others;
}

/// A term of the grammar along the fitted rows.
struct grammar_term {
    std::string text;
    std::string unit;
    Eigen::VectorXd values;
};

/// What a signal is called in an effect file of `joint`.
std::string word_of(const signal_source& source, int joint) {
    constexpr const char* words[] = {"q", "qd", "qdd", "tau_rigid", "temp", "t"};
    return std::string(words[static_cast<int>(source.what)]) + (source.joint == joint ? "" : "_from");
}

struct unit_powers {
    int radian = 0, second = 0, torque = 0, kelvin = 0;

    void add(signal_source::kind what, int power) {
        using kind = signal_source::kind;
        radian += what == kind::q || what == kind::qd || what == kind::qdd ? power : 0;
        second += what == kind::qd ? power : (what == kind::qdd ? 2 * power : 0);
        torque += what == kind::tau ? power : 0;
        kelvin += what == kind::temp ? power : 0;
    }

    std::string text() const {
        const auto power = [](const char* unit, int of) {
            return of == 1 ? std::string(unit) : fmt::format("{}^{}", unit, of);
        };
        std::string result = torque == 0 ? "N*m" : (torque == 1 ? "1" : "1/" + power("(N*m)", torque - 1));
        result += second > 0 ? "*" + power("s", second) : "";
        result += radian > 0 ? "/" + power("rad", radian) : "";
        return result + (kelvin > 0 ? "/" + power("degC", kelvin) : "");
    }
};

std::string with_word(const char* text, const std::string& word) {
    std::string result;
    for (const char* c = text; *c != '\0'; ++c) {
        const bool place = c[0] == '{' && c[1] == '}';
        result += place ? word : std::string(1, *c);
        c += place ? 1 : 0;
    }
    return result;
}

std::vector<grammar_term> terms_of(const joint_residual& rows, const signal_dependence& dependence) {
    const auto term = [&](const std::vector<const signal_function*>& factors) {
        grammar_term made{"", "", rows.weight};
        unit_powers powers;
        for (std::size_t s = 0; s < factors.size(); ++s) {
            if (factors[s] != nullptr) {
                const signal_source& source = dependence.signals[s];
                made.text +=
                    (made.text.empty() ? "" : "*") + with_word(factors[s]->text, word_of(source, dependence.joint));
                made.values.array() *=
                    rows.signals.col(static_cast<Eigen::Index>(s)).unaryExpr(factors[s]->value).array();
                powers.add(source.what, factors[s]->power);
            }
        }
        made.unit = powers.text();
        return made;
    };
    std::vector<grammar_term> all;
    if (dependence.signals.size() == 1) {
        for (const signal_function& f : functions_of(dependence.signals[0].what)) {
            all.push_back(term({&f}));
        }
        return all;
    }
    for (const signal_function& f : functions_of(dependence.signals[0].what)) {
        all.push_back(term({&f, nullptr}));
    }
    for (const signal_function& g : functions_of(dependence.signals[1].what)) {
        all.push_back(term({nullptr, &g}));
        for (const signal_function& f : functions_of(dependence.signals[0].what)) {
            all.push_back(term({&f, &g}));
        }
    }
    return all;
}

Eigen::MatrixXd outside(const Eigen::MatrixXd& model, const Eigen::MatrixXd& A) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-6);
    solver.compute(model);
    return A - model * solver.solve(A);
}

/// Columns (of norm 1 before the model was taken off) chosen one after the other, each taken off the rest.
std::vector<Eigen::Index> forward_regression(Eigen::MatrixXd columns, Eigen::VectorXd left) {
    std::vector<Eigen::Index> chosen;
    double first_gain = 0.0;
    while (chosen.size() < most_terms) {
        Eigen::Index best = -1;
        double gain = 0.0;
        for (Eigen::Index k = 0; k < columns.cols(); ++k) {
            const double there = columns.col(k).norm();
            if (there > collinear) {
                const double part = columns.col(k).dot(left) / there;
                best = part * part > gain ? k : best;
                gain = std::max(gain, part * part);
            }
        }
        if (best < 0 || gain < least_share * first_gain) {
            break;
        }
        first_gain = chosen.empty() ? gain : first_gain;
        chosen.push_back(best);
        const Eigen::VectorXd direction = columns.col(best).normalized();
        left -= direction * direction.dot(left);
        columns -= direction * (direction.transpose() * columns);
    }
    return chosen;
}

/// Rows of a random half of the blocks.
std::vector<Eigen::Index> half_of(Eigen::Index rows, std::mt19937_64& random) {
    std::vector<Eigen::Index> order(blocks);
    for (Eigen::Index b = 0; b < blocks; ++b) {
        order[static_cast<std::size_t>(b)] = b;
    }
    for (std::size_t b = order.size() - 1; b > 0; --b) {
        std::swap(order[b], order[random() % (b + 1)]);
    }
    std::vector<Eigen::Index> kept;
    for (std::size_t b = 0; b < order.size() / 2; ++b) {
        for (Eigen::Index k = rows * order[b] / blocks; k < rows * (order[b] + 1) / blocks; ++k) {
            kept.push_back(k);
        }
    }
    return kept;
}

/// Which of `chosen` are chosen, they or one nearly the same, in most halves of the rows.
std::vector<Eigen::Index> stable_terms(const Eigen::MatrixXd& columns, const Eigen::VectorXd& left,
                                       const std::vector<Eigen::Index>& chosen) {
    const Eigen::MatrixXd unit = columns.colwise().normalized();
    std::vector<int> count(chosen.size(), 0);
    std::mt19937_64 random(seed);
    for (int half = 0; half < halves; ++half) {
        const std::vector<Eigen::Index> rows = half_of(columns.rows(), random);
        const std::vector<Eigen::Index> again = forward_regression(columns(rows, Eigen::all), left(rows));
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            count[i] += std::any_of(again.begin(), again.end(), [&](Eigen::Index k) {
                return std::abs(unit.col(k).dot(unit.col(chosen[i]))) > nearly_the_same;
            });
        }
    }
    std::vector<Eigen::Index> stable;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (count[i] >= stable_share * halves) {
            stable.push_back(chosen[i]);
        }
    }
    return stable;
}

/// The one joint beside `joint` whose signals are used; -1 for none, nothing where an effect file cannot say it.
std::optional<int> other_joint(const signal_dependence& dependence) {
    using kind = signal_source::kind;
    int other = -1;
    for (const signal_source& source : dependence.signals) {
        if (source.what == kind::t) {
            return std::nullopt;
        }
        if (source.joint != dependence.joint) {
            if (other >= 0 && other != source.joint) {
                return std::nullopt;
            }
            other = source.joint;
        }
    }
    return other;
}

}  // namespace

std::optional<proposed_torque> propose(const trace_fit& fit, const signal_dependence& dependence) {
    const std::optional<int> other = other_joint(dependence);
    if (!other) {
        return std::nullopt;
    }
    const joint_residual rows = residual_of(fit, dependence.joint, dependence.signals, false);
    const std::vector<grammar_term> grammar = terms_of(rows, dependence);
    Eigen::MatrixXd all(rows.left.size(), static_cast<Eigen::Index>(grammar.size()) + 1);
    for (std::size_t k = 0; k < grammar.size(); ++k) {
        all.col(static_cast<Eigen::Index>(k)) = grammar[k].values.normalized();
    }
    all.rightCols(1) = rows.left;
    all = outside(rows.model, all);
    const Eigen::MatrixXd columns = all.leftCols(all.cols() - 1);
    const Eigen::VectorXd left = all.rightCols(1);
    proposed_torque proposal;
    for (const Eigen::Index k : stable_terms(columns, left, forward_regression(columns, left))) {
        proposal.terms.push_back(grammar[static_cast<std::size_t>(k)].text);
        proposal.units.push_back(grammar[static_cast<std::size_t>(k)].unit);
    }
    if (proposal.terms.empty()) {
        return std::nullopt;
    }
    if (*other >= 0) {
        proposal.from = other;
    }
    return proposal;
}

}  // namespace idim
