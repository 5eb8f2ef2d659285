// A change of a robot changes only those lines of its code that depend on it: what a reviewer has to read.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>
#include <sstream>

#include "generator.hpp"
#include "idim/unified_diff.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

using generator::rendered_file;

/// The files of a robot before and after a change of its description.
class ChangedLines : public testing::Test {
  protected:
    /// What stands as `entry` in the robot's description becomes `before`, then `after`.
    void change(const std::string& robot, const std::string& entry, const std::string& before,
                const std::string& after) {
        const std::string text = read_text(robot_file(robot));
        std::filesystem::copy(std::filesystem::path(robot_file(robot)).parent_path(), folder_.path(),
                              std::filesystem::copy_options::recursive);
        before_ = files_of(robot, replaced(text, entry, before));
        after_ = files_of(robot, replaced(text, entry, after));
        ASSERT_EQ(before_.size(), after_.size());
    }

    /// Lines of the C++ files that only one side has, without the sign in front.
    std::vector<std::string> changed() const {
        std::vector<std::string> lines;
        for (std::size_t i = 0; i < before_.size(); ++i) {
            std::istringstream diff(unified_diff({{before_[i].name, before_[i].text, after_[i].text}}));
            for (std::string line; std::getline(diff, line);) {
                const bool is_line = line[0] == '-' || line[0] == '+';
                if (is_line && line.rfind("--- ", 0) != 0 && line.rfind("+++ ", 0) != 0) {
                    lines.push_back(line.substr(1));
                }
            }
        }
        return lines;
    }

    std::vector<rendered_file> before_, after_;

  private:
    std::vector<rendered_file> files_of(const std::string& robot, const std::string& text) const {
        std::vector<rendered_file> files =
            generator::generate(folder_.write(robot + ".yaml", text), templates_folder).files;
        files.erase(std::remove_if(files.begin(), files.end(),
                                   [](const rendered_file& file) { return file.name == "manifest.json"; }),
                    files.end());
        return files;
    }

    temporary_folder folder_;
};

const std::regex literal("Scalar\\(([0-9.e-]+)\\)");

std::vector<double> literals(const std::string& line) {
    std::vector<double> values;
    for (std::sregex_iterator it(line.begin(), line.end(), literal); it != std::sregex_iterator(); ++it) {
        values.push_back(std::stod((*it)[1].str()));
    }
    return values;
}

/// Among `values`, but for the last digit that a product has more.
bool holds_one_of(const std::string& line, const std::vector<double>& values) {
    const std::vector<double> found = literals(line);
    return std::any_of(found.begin(), found.end(), [&values](double x) {
        return std::any_of(values.begin(), values.end(), [x](double v) { return std::abs(x - v) < 1e-12; });
    });
}

bool is_hash(const std::string& line) {
    return line.find("input_hash = ") != std::string::npos;
}

/// Variables that a body defines.
std::set<std::string> names_defined(const std::vector<rendered_file>& files) {
    static const std::regex definition("const Scalar&? ([A-Za-z0-9_]+) =");
    std::set<std::string> names;
    for (const rendered_file& file : files) {
        for (std::sregex_iterator it(file.text.begin(), file.text.end(), definition); it != std::sregex_iterator();
             ++it) {
            names.insert(file.name + " " + (*it)[1].str());
        }
    }
    return names;
}

TEST_F(ChangedLines, OfALengthOfTheScaraHoldThatLength) {
    change("scara", "L: 0.5", "L: 0.45", "L: 0.55");  // not from 0.5, where 2 L = 1 saves a product
    for (const std::string& line : changed()) {
        EXPECT_TRUE(is_hash(line) || line.rfind("//   L = ", 0) == 0 ||
                    holds_one_of(line, {0.45, 0.9, 0.45 * 0.45, 0.55, 1.1, 0.55 * 0.55}))
            << line;
    }
    for (std::size_t i = 0; i < before_.size(); ++i) {
        const auto shape = [](const rendered_file& file) { return std::regex_replace(file.text, literal, "#"); };
        if (before_[i].name != "model.hpp") {
            EXPECT_EQ(shape(before_[i]), shape(after_[i])) << before_[i].name << ": more than numbers changed";
        }
    }
}

TEST_F(ChangedLines, OfALengthOfASixJointArmHoldThatLength) {
    change("denso_vp6242g", "l3x: 0.075", "l3x: 0.075", "l3x: 0.08");
    std::vector<double> values;
    for (const double x : {0.075, 0.08}) {
        constexpr double y = 0.21;  // both l2 and l3z + l4: the frame of the fourth joint is (-x, y, 0) from the third
        for (const double v : {x, 2.0 * x, x * x, x * y, 2.0 * x * y, y * y + x * x, y * y - x * x}) {
            values.push_back(v);
        }
    }
    for (const std::string& line : changed()) {
        EXPECT_TRUE(is_hash(line) || line.rfind("//   l3x = ", 0) == 0 || holds_one_of(line, values)) << line;
    }
    EXPECT_EQ(names_defined(before_), names_defined(after_));
}

TEST_F(ChangedLines, OfAnEffectAtTheFirstOfSixJointsNameItOrCountIt) {
    change("denso_vp6242g", "effects: [viscous_friction, coulomb_friction]",
           "effects: [viscous_friction, coulomb_friction]",
           "effects: [viscous_friction, coulomb_friction, {effect: torque_offset, joints: [j1]}]");
    const std::regex count(
        "// Robot denso_vp6242g, [a-z_]+: .*|"
        "inline constexpr int (base|standard)_parameters = [0-9]+;");
    std::size_t named = 0;
    for (const std::string& line : changed()) {
        const bool names_it = line.find("off1") != std::string::npos || line == "//   torque_offset at j1";
        named += names_it ? 1 : 0;
        const bool was_sum = line.find("Fv1 * qd[0] + Fc1 * sign(qd[0])") != std::string::npos;
        EXPECT_TRUE(names_it || was_sum || is_hash(line) || line == "    \"N*m\"," || std::regex_match(line, count))
            << line;
    }
    EXPECT_GE(named, 6u) << "the column of the regressor";
}

TEST_F(ChangedLines, OfALengthThatBecomesZeroBringNoNewName) {
    change("denso_vp6242g", "l5: 0.07", "l5: 0.07", "l5: 0");
    // Without l5 the last axis meets the two before it, and the regressor carries forces of the last link to where
    // theirs go: those names are new.
    const auto without_regressor = [](std::vector<rendered_file> files) {
        files.erase(std::remove_if(files.begin(), files.end(),
                                   [](const rendered_file& file) { return file.name == "regressor.hpp"; }),
                    files.end());
        return names_defined(files);
    };
    const std::set<std::string> before = without_regressor(before_);
    const std::set<std::string> after = without_regressor(after_);
    EXPECT_LT(after.size(), before.size());
    EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
}

TEST_F(ChangedLines, OfAControlGainAreTheHashAlone) {
    change("denso_vp6242g", "rate: 1000", "rate: 1000", "rate: 500");
    for (const std::string& line : changed()) {
        EXPECT_TRUE(is_hash(line)) << line;
    }
}

}  // namespace

}  // namespace idim::test
