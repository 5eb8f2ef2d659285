#include "structure_proposal.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "column_span.hpp"

namespace idim {

namespace {

constexpr int blocks = 10;  ///< of cross-validation, each a stretch of time
/// Of the residual: of forms that explain as much but for this the simplest is taken.
constexpr double as_good_form = 0.02;
constexpr double least_by_form = 0.05;  ///< of the residual, in the blocks left out
constexpr double collinear = 1e-3;      ///< part of a term's norm that is left outside the model

/// A function of a signal, as it is written and as it is evaluated; {} stands for the signal.
struct signal_function {
    const char* text;
    std::function<double(double)> value;
    int power;  ///< of the signal's unit
};

double sign(double x) {
    return static_cast<double>(x > 0.0) - static_cast<double>(x < 0.0);
}

/// Functions that make a form together: a wave has its phase.
using function_family = std::vector<signal_function>;

/// From the simplest on.
const std::vector<function_family>& families_of(signal_source::kind what) {
    static const signal_function linear = {"{}", [](double x) { return x; }, 1};
    static const signal_function square = {"{}^2", [](double x) { return x * x; }, 2};
    static const std::vector<function_family> positions = {
        {linear},
        {{"cos({})", [](double x) { return std::cos(x); }, 0}, {"sin({})", [](double x) { return std::sin(x); }, 0}},
        {linear, square},
        {{"cos(2*{})", [](double x) { return std::cos(2.0 * x); }, 0},
         {"sin(2*{})", [](double x) { return std::sin(2.0 * x); }, 0}},
        {{"cos(3*{})", [](double x) { return std::cos(3.0 * x); }, 0},
         {"sin(3*{})", [](double x) { return std::sin(3.0 * x); }, 0}},
    };
    static const std::vector<function_family> others = {
        {linear},
        {{"abs({})", [](double x) { return std::abs(x); }, 1}},
        {{"sign({})", sign, 0}},
        {square},
        {{"{}*abs({})", [](double x) { return x * std::abs(x); }, 2}},
        {{"{}^3", [](double x) { return x * x * x; }, 3}},
        {linear, square},
    };
    return what == signal_source::kind::q ? positions : others;
}

/// A term along the fitted rows.
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

/// The product of one function of each signal; null: none of that signal.
grammar_term product(const joint_residual& rows, const signal_dependence& dependence,
                     const std::vector<const signal_function*>& factors) {
    grammar_term made{"", "", rows.weight};
    unit_powers powers;
    for (std::size_t s = 0; s < factors.size(); ++s) {
        if (factors[s] != nullptr) {
            const signal_source& source = dependence.signals[s];
            made.text +=
                (made.text.empty() ? "" : "*") + with_word(factors[s]->text, word_of(source, dependence.joint));
            made.values.array() *= rows.signals.col(static_cast<Eigen::Index>(s)).unaryExpr(factors[s]->value).array();
            powers.add(source.what, factors[s]->power);
        }
    }
    made.unit = powers.text();
    return made;
}

using grammar_form = std::vector<grammar_term>;

/// Every form of the signals: a family of one, or all products of two families with each other and with 1.
std::vector<grammar_form> forms_of(const joint_residual& rows, const signal_dependence& dependence) {
    std::vector<grammar_form> forms;
    for (const function_family& first : families_of(dependence.signals[0].what)) {
        if (dependence.signals.size() == 1) {
            forms.emplace_back();
            for (const signal_function& f : first) {
                forms.back().push_back(product(rows, dependence, {&f}));
            }
            continue;
        }
        for (const function_family& second : families_of(dependence.signals[1].what)) {
            forms.emplace_back();
            for (const signal_function& f : first) {
                forms.back().push_back(product(rows, dependence, {&f, nullptr}));
            }
            for (const signal_function& g : second) {
                forms.back().push_back(product(rows, dependence, {nullptr, &g}));
                for (const signal_function& f : first) {
                    forms.back().push_back(product(rows, dependence, {&f, &g}));
                }
            }
        }
    }
    return forms;
}

/// Terms of a form that show outside the model, and how much of the residual they explain.
struct fitted_form {
    grammar_form terms;
    double explained = 0.0;  ///< in stretches of time that were left out, each fitted on the others
};

/// Share of y that columns C explain in each block, fitted on the others.
double cross_validated(const Eigen::MatrixXd& C, const Eigen::VectorXd& y) {
    const Eigen::Index n = C.rows();
    const Eigen::MatrixXd all = C.transpose() * C;
    const Eigen::VectorXd with_y = C.transpose() * y;
    double left = 0.0;
    for (Eigen::Index b = 0; b < blocks; ++b) {
        const Eigen::Index first = n * b / blocks;
        const Eigen::Index count = n * (b + 1) / blocks - first;
        const auto part = C.middleRows(first, count);
        const auto y_part = y.segment(first, count);
        const Eigen::VectorXd coefficient =
            (all - part.transpose() * part).ldlt().solve(with_y - part.transpose() * y_part);
        left += (y_part - part * coefficient).squaredNorm();
    }
    return 1.0 - left / y.squaredNorm();
}

/// `left`: the residual, outside the span of the model.
fitted_form fit_form(const Eigen::MatrixXd& span, const Eigen::VectorXd& left, const grammar_form& form) {
    Eigen::MatrixXd all(left.size(), static_cast<Eigen::Index>(form.size()));
    for (std::size_t k = 0; k < form.size(); ++k) {
        all.col(static_cast<Eigen::Index>(k)) = form[k].values.normalized();
    }
    all = outside(span, all);
    fitted_form fitted;
    std::vector<Eigen::Index> shown;
    for (std::size_t k = 0; k < form.size(); ++k) {
        if (all.col(static_cast<Eigen::Index>(k)).norm() > collinear) {
            shown.push_back(static_cast<Eigen::Index>(k));
            fitted.terms.push_back(form[k]);
        }
    }
    if (!shown.empty()) {
        fitted.explained = cross_validated(all(Eigen::all, shown).colwise().normalized(), left);
    }
    return fitted;
}

/// The form that explains most where it was not fitted, or a simpler one that does nearly as well, without the terms
/// that it does as well without.
fitted_form best_form(const joint_residual& rows, const signal_dependence& dependence) {
    const Eigen::MatrixXd span = orthonormal(rows.model);
    const Eigen::VectorXd left = outside(span, rows.left);
    std::vector<fitted_form> fitted;
    for (const grammar_form& form : forms_of(rows, dependence)) {
        fitted.push_back(fit_form(span, left, form));
    }
    double most = 0.0;
    for (const fitted_form& form : fitted) {
        most = std::max(most, form.explained);
    }
    fitted_form best;
    for (const fitted_form& form : fitted) {
        const bool simpler = best.terms.empty() || form.terms.size() < best.terms.size() ||
                             (form.terms.size() == best.terms.size() && form.explained > best.explained);
        if (!form.terms.empty() && form.explained >= most - as_good_form && simpler) {
            best = form;
        }
    }
    for (std::size_t k = 0; k < best.terms.size() && best.terms.size() > 1;) {
        grammar_form fewer = best.terms;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
        const fitted_form without = fit_form(span, left, fewer);
        if (without.explained >= best.explained - 0.5 * as_good_form) {
            best = without;
        } else {
            ++k;
        }
    }
    return best;
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
    const fitted_form best = best_form(rows, dependence);
    if (best.explained < least_by_form) {
        return std::nullopt;
    }
    proposed_torque proposal;
    for (const grammar_term& term : best.terms) {
        proposal.terms.push_back(term.text);
        proposal.units.push_back(term.unit);
    }
    if (*other >= 0) {
        proposal.from = other;
    }
    return proposal;
}

}  // namespace idim
