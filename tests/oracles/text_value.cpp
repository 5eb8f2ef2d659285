#include "oracles/text_value.hpp"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

namespace idim::test {

namespace {

class reader {
  public:
    reader(const std::string& text, const value_table& names) : text_(text), names_(names) {}

    double run() {
        const double value = sum();
        if (peek() != '\0') {
            fail();
        }
        return value;
    }

  private:
    char peek() {
        while (at_ < text_.size() && text_[at_] == ' ') {
            ++at_;
        }
        return at_ < text_.size() ? text_[at_] : '\0';
    }

    bool take(char c) {
        const bool found = peek() == c;
        at_ += found ? 1 : 0;
        return found;
    }

    [[noreturn]] void fail() const {
        throw std::runtime_error("no value of \"" + text_ + "\", stopped at character " + std::to_string(at_ + 1));
    }

    double sum() {
        double value = product();
        for (;;) {
            if (take('+')) {
                value += product();
            } else if (take('-')) {
                value -= product();
            } else {
                return value;
            }
        }
    }

    double product() {
        double value = factor();
        for (;;) {
            if (take('*')) {
                value *= factor();
            } else if (take('/')) {
                value /= factor();
            } else {
                return value;
            }
        }
    }

    double factor() {
        if (take('-')) {
            return -factor();
        }
        const double base = atom();
        return take('^') ? std::pow(base, factor()) : base;
    }

    double atom() {
        if (take('(')) {
            const double value = sum();
            if (!take(')')) {
                fail();
            }
            return value;
        }
        if (std::isalpha(static_cast<unsigned char>(peek())) != 0) {
            return named();
        }
        const char* const start = text_.c_str() + at_;
        char* end = nullptr;
        const double value = std::strtod(start, &end);
        if (end == start) {
            fail();
        }
        at_ += static_cast<std::size_t>(end - start);
        return value;
    }

    double named() {
        std::string name;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) {
            name += text_[at_++];
        }
        if (name == "sin" || name == "cos" || name == "sqrt") {
            const double x = atom();
            return name == "sin" ? std::sin(x) : name == "cos" ? std::cos(x) : std::sqrt(x);
        }
        const auto known = names_.find(name);
        if (known != names_.end()) {
            return known->second;
        }
        if (name == "pi") {
            return std::numbers::pi;
        }
        fail();
    }

    const std::string& text_;
    const value_table& names_;
    std::size_t at_ = 0;
};

}  // namespace

double text_value(const std::string& text, const value_table& names) {
    return reader(text, names).run();
}

}  // namespace idim::test
