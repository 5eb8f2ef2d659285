#include "idim/unified_diff.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace idim {

TEST(UnifiedDiff, HasThreeLinesOfContextAndNamesTheFile) {
    const file_change change{"model.hpp", "1\n2\n3\n4\n5\n6\n7\n8\n9\n", "1\n2\n3\n4\nfive\n6\n7\n8\n9\n"};
    EXPECT_EQ(unified_diff({change}),
              "--- a/model.hpp\n+++ b/model.hpp\n@@ -2,7 +2,7 @@\n 2\n 3\n 4\n-5\n+five\n 6\n 7\n 8\n");
}

TEST(UnifiedDiff, AFileThatIsMissingOnOneSideIsDevNull) {
    EXPECT_EQ(unified_diff({{"new.hpp", std::nullopt, "a\n"}, {"old.hpp", "b\n", std::nullopt}}),
              "--- /dev/null\n+++ b/new.hpp\n@@ -0,0 +1 @@\n+a\n--- a/old.hpp\n+++ /dev/null\n@@ -1 +0,0 @@\n-b\n");
}

TEST(UnifiedDiff, OfEqualTextsIsEmpty) {
    EXPECT_EQ(unified_diff({}), "");
    EXPECT_EQ(unified_diff({{"same.hpp", "a\n", "a\n"}, {"none.hpp", std::nullopt, std::nullopt}}), "");
}

TEST(UnifiedDiff, SaysWhereTheLastLineBreakIsMissing) {
    EXPECT_EQ(unified_diff({{"a", "x", "x\n"}}),
              "--- a/a\n+++ b/a\n@@ -1 +1 @@\n-x\n\\ No newline at end of file\n+x\n");
}

TEST(UnifiedDiff, BytesThatAreNoTextAreComparedAsLines) {
    const std::string before("a\0b\n", 4);
    EXPECT_EQ(unified_diff({{"a", before, "\xff\n"}}), "--- a/a\n+++ b/a\n@@ -1 +1 @@\n-" + before + "+\xff\n");
}

TEST(UnifiedDiff, WithoutAProgramDiffTheMessageNamesIt) {
    const std::string path = std::getenv("PATH");
    ASSERT_EQ(setenv("PATH", "/nonexistent", 1), 0);
    try {
        unified_diff({{"a", "x\n", "y\n"}});
        ADD_FAILURE() << "found one";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("diff"), std::string::npos) << error.what();
    }
    setenv("PATH", path.c_str(), 1);
}

}  // namespace idim
