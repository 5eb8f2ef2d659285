#include "description/identifier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

#include "support/robot_files.hpp"

namespace idim::generator {

namespace {

/// The words in the quotes, or between the parentheses, that follow `start` in a file of the sources.
std::set<std::string> words_behind(const std::string& file, const std::string& start, char end) {
    const std::string text = test::read_text(test::source_folder + "/" + file);
    const std::size_t from = text.find(start) + start.size();
    std::string list = text.substr(from, text.find(end, from) - from);
    std::replace(list.begin(), list.end(), '"', ' ');
    std::istringstream words(list);
    return {std::istream_iterator<std::string>(words), {}};
}

const input_location somewhere = {"robot.urdf", 1, "name"};

}  // namespace

TEST(NearestName, MakesIdentifiersOfWhatUrdfFilesCallThings) {
    EXPECT_EQ(nearest_name("left arm-2", 'r', somewhere), "left_arm_2");
    EXPECT_EQ(nearest_name("7dof", 'r', somewhere), "r7dof");
    EXPECT_EQ(nearest_name("class", 'r', somewhere), "class_");
    EXPECT_EQ(nearest_name("classes", 'r', somewhere), "classes");
}

TEST(NearestName, IsTheOneThatTheBuildExpects) {
    const auto in_build = words_behind("runtime/cmake/idim_generate.cmake", "set(language_names", ')');
    EXPECT_EQ(in_build, words_behind("generator/description/identifier.cpp", "language_names =", ';'));
    EXPECT_GT(in_build.size(), 100u);
    for (const std::string& word : in_build) {
        EXPECT_EQ(nearest_name(word, 'r', somewhere), word + "_");
        EXPECT_THROW(checked_name(word, somewhere), input_error) << word;
    }
}

}  // namespace idim::generator
