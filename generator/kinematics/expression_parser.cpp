#include "kinematics/expression_parser.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

namespace idim::generator {

REGISTER_FUNCTION(sign, dummy())

namespace {

constexpr std::size_t longest_expression = 1000;
constexpr int largest_exponent = 16;
constexpr int deepest_nesting = 50;

[[noreturn]] void fail(const expression_text& source, const std::string& message) {
    throw input_error(source.where, fmt::format("expression \"{}\": {}", source.text, message));
}

bool is_identifier_start(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_identifier_part(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_decimal(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

const std::vector<std::string>& function_names() {
    static const std::vector<std::string> names = {"sin",  "cos", "tan",  "exp",  "log",
                                                   "sqrt", "abs", "sign", "tanh", "atan"};
    return names;
}

bool is_function(const std::string& name) {
    const auto& names = function_names();
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// "0.25" -> 1/4, "1e-3" -> 1/1000, exactly.
GiNaC::ex decimal_value(const std::string& literal, const expression_text& source) {
    std::size_t used = 0;
    std::string digits;
    int scale = 0;
    bool after_point = false;
    for (; used < literal.size() && literal[used] != 'e' && literal[used] != 'E'; ++used) {
        if (literal[used] == '.') {
            after_point = true;
        } else {
            digits += literal[used];
            scale -= after_point ? 1 : 0;
        }
    }
    constexpr std::size_t longest_exponent = 4;  // with its sign
    const std::string exponent = used < literal.size() ? literal.substr(used + 1) : "0";
    scale += exponent.size() > longest_exponent ? 1000 : std::stoi(exponent);
    if (digits.size() > 60 || std::abs(scale) > 60) {
        fail(source, fmt::format("number {} has too many digits", literal));
    }
    return GiNaC::numeric(digits.c_str()) * GiNaC::pow(GiNaC::numeric(10), scale);
}

/// The text with every number replaced by a placeholder symbol, so that nothing is evaluated before it has been looked
/// at.
struct tokenised {
    std::string text;
    GiNaC::symtab symbols;
    GiNaC::exmap numbers;
};

class tokeniser {
  public:
    tokeniser(const expression_text& source, const named_values& names) : source_(source), names_(names) {}

    tokenised run() {
        if (source_.text.size() > longest_expression) {
            throw input_error(source_.where, fmt::format("expression of {} characters, expected at most {}",
                                                         source_.text.size(), longest_expression));
        }
        while (at_ < source_.text.size()) {
            step();
        }
        if (depth_ != 0) {
            fail(source_, "expected a closing parenthesis");
        }
        return std::move(result_);
    }

  private:
    void step() {
        const char c = source_.text[at_];
        if (is_identifier_start(c)) {
            identifier();
        } else if (is_decimal(c) || c == '.') {
            number();
        } else if (std::string_view("+-*/^() ").find(c) != std::string_view::npos) {
            depth_ += c == '(' ? 1 : c == ')' ? -1 : 0;
            if (depth_ < 0) {
                fail(source_, "closing parenthesis without an opening one");
            }
            if (depth_ > deepest_nesting) {
                fail(source_, fmt::format("nested deeper than {} parentheses", deepest_nesting));
            }
            if (c == ')' && result_.text[result_.text.find_last_not_of(' ')] == '(') {
                fail(source_, "nothing between parentheses");  // GiNaC reads past a call without arguments
            }
            result_.text += c;
            ++at_;
        } else {
            fail(source_, fmt::format("unexpected character at position {}", at_ + 1));
        }
    }

    void identifier() {
        const std::size_t start = at_;
        while (at_ < source_.text.size() && is_identifier_part(source_.text[at_])) {
            ++at_;
        }
        const std::string name = source_.text.substr(start, at_ - start);
        if (name == "pi" || is_function(name)) {
            result_.text += name == "pi" ? "Pi" : name;
            return;
        }
        const auto known = names_.find(name);
        if (known == names_.end()) {
            std::vector<std::string> all;
            for (const auto& [other, value] : names_) {
                all.push_back(other);
            }
            fail(source_, fmt::format("unknown symbol \"{}\", expected one of: {}{}pi", name, fmt::join(all, ", "),
                                      all.empty() ? "" : ", "));
        }
        // A prefix, so that no name can mean a constant of the parser (I, Euler, Catalan).
        result_.text += "s_" + name;
        result_.symbols["s_" + name] = known->second;
    }

    void number() {
        const std::size_t start = at_;
        const std::string& text = source_.text;
        while (at_ < text.size() && (is_decimal(text[at_]) || text[at_] == '.')) {
            ++at_;
        }
        if (at_ + 1 < text.size() && (text[at_] == 'e' || text[at_] == 'E')) {
            std::size_t digit = at_ + 1;
            digit += text[digit] == '+' || text[digit] == '-' ? 1 : 0;
            if (digit < text.size() && is_decimal(text[digit])) {
                at_ = digit;
                while (at_ < text.size() && is_decimal(text[at_])) {
                    ++at_;
                }
            }
        }
        const std::string literal = text.substr(start, at_ - start);
        const bool dangling = at_ < text.size() && is_identifier_start(text[at_]);
        if (dangling || std::count(literal.begin(), literal.end(), '.') > 1 || literal == "." || literal.size() > 64) {
            fail(source_, fmt::format("malformed number \"{}\"", text.substr(start, at_ - start + (dangling ? 1 : 0))));
        }
        const std::string name = fmt::format("n_{}", result_.numbers.size());
        const GiNaC::symbol placeholder(name);
        result_.symbols[name] = placeholder;
        result_.numbers[placeholder] = decimal_value(literal, source_);
        result_.text += name;
    }

    const expression_text& source_;
    const named_values& names_;
    tokenised result_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

/// Puts the numbers back bottom-up, refusing powers that would explode.
struct number_restorer : public GiNaC::map_function {
    number_restorer(const GiNaC::exmap& values, const expression_text& text) : numbers(values), source(text) {}

    GiNaC::ex operator()(const GiNaC::ex& e) override {
        if (GiNaC::is_a<GiNaC::symbol>(e)) {
            const auto found = numbers.find(e);
            return found == numbers.end() ? e : found->second;
        }
        if (GiNaC::is_a<GiNaC::power>(e)) {
            const GiNaC::ex base = (*this)(e.op(0));
            const GiNaC::ex exponent = (*this)(e.op(1));
            if (GiNaC::is_a<GiNaC::numeric>(exponent)) {
                const auto value = GiNaC::ex_to<GiNaC::numeric>(exponent);
                if (GiNaC::abs(value) > largest_exponent) {
                    fail(source, fmt::format("exponent beyond {}", largest_exponent));
                }
                limit_size(base);
            }
            return GiNaC::pow(base, exponent);
        }
        return e.map(*this);
    }

    void limit_size(const GiNaC::ex& base) const {
        if (!GiNaC::is_a<GiNaC::numeric>(base)) {
            return;
        }
        const auto value = GiNaC::ex_to<GiNaC::numeric>(base);
        if (value.is_rational() && value.numer().int_length() + value.denom().int_length() > 400) {
            fail(source, "power of a number with too many digits");
        }
    }

    const GiNaC::exmap& numbers;
    const expression_text& source;
};

GiNaC::prototype_table readers() {
    const GiNaC::prototype_table& all = GiNaC::get_default_reader();
    GiNaC::prototype_table chosen;
    for (const std::string& name : function_names()) {
        const auto found = all.find({name, 1});
        if (found == all.end()) {
            throw std::logic_error("the expression parser does not know " + name);
        }
        chosen.insert(*found);
    }
    return chosen;
}

}  // namespace

GiNaC::ex parse_expression(const expression_text& source, const named_values& names) {
    const tokenised tokens = tokeniser(source, names).run();
    if (tokens.text.find_first_not_of(' ') == std::string::npos) {
        fail(source, "expected an expression");
    }
    static const GiNaC::prototype_table functions = readers();
    try {
        GiNaC::parser parser(tokens.symbols, true, functions);
        return number_restorer(tokens.numbers, source)(parser(tokens.text));
    } catch (const input_error&) {
        throw;
    } catch (const GiNaC::pole_error&) {
        fail(source, "division by zero");
    } catch (const std::exception&) {
        fail(source, "malformed, expected numbers, names, + - * / ^, parentheses and functions such as sin(q)");
    }
}

GiNaC::numeric constant_value(const GiNaC::ex& expression, const input_location& where) {
    if (GiNaC::is_a<GiNaC::numeric>(expression) && GiNaC::ex_to<GiNaC::numeric>(expression).is_rational()) {
        return GiNaC::ex_to<GiNaC::numeric>(expression);
    }
    GiNaC::Digits = 60;
    GiNaC::ex value;
    try {
        value = expression.evalf();
    } catch (const std::exception&) {
        throw input_error(where, "expected a finite number");  // overflow in CLN
    }
    if (!GiNaC::is_a<GiNaC::numeric>(value) || !GiNaC::ex_to<GiNaC::numeric>(value).is_real()) {
        throw input_error(where, "expected a real number");
    }
    const auto number = GiNaC::ex_to<GiNaC::numeric>(value);
    const GiNaC::numeric largest = GiNaC::numeric(10).power(60);
    if (GiNaC::abs(number) > largest || (!number.is_zero() && GiNaC::abs(number) < 1 / largest)) {
        throw input_error(where,
                          "expected a number from 1e-60 to 1e60 in size");  // its fraction may not fit into memory
    }
    return GiNaC::numeric(cln::rational(cln::realpart(number.to_cl_N())));
}

}  // namespace idim::generator
