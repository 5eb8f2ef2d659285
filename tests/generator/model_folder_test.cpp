#include "emit/model_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "emit/manifest_file.hpp"
#include "idim/input_error.hpp"
#include "support/robot_files.hpp"

namespace idim::generator {

namespace {

using lines = std::vector<std::string>;

std::vector<rendered_file> model(const std::string& text, bool with_extra) {
    std::vector<rendered_file> files = {{"a.hpp", text}, {"b.hpp", "b\n"}};
    std::string listed = "\"a.hpp\", \"b.hpp\"";
    if (with_extra) {
        files.push_back({"extra.hpp", "extra\n"});
        listed += ", \"extra.hpp\"";
    }
    files.push_back({"manifest.json", "{\"files\": [" + listed + "]}\n"});
    return files;
}

class ModelFolder : public testing::Test {
  protected:
    std::string path() const { return (folder_.path() / "deep/model").string(); }
    bool exists(const std::string& name) const { return std::filesystem::exists(path() + "/" + name); }
    ino_t inode(const std::string& name) const {
        struct stat status {};
        EXPECT_EQ(stat((path() + "/" + name).c_str(), &status), 0);
        return status.st_ino;
    }
    std::size_t count() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path()), {}));
    }

    test::temporary_folder folder_;
};

TEST_F(ModelFolder, IsMadeWithAllFilesAndNothingElse) {
    EXPECT_EQ(write_model(model("a\n", true), path()).size(), 4u);
    EXPECT_EQ(test::read_text(path() + "/a.hpp"), "a\n");
    EXPECT_EQ(count(), 4u);  // no temporary is left
}

TEST_F(ModelFolder, FilesWhoseBytesStayAreNotTouched) {
    write_model(model("a\n", false), path());
    const ino_t a = inode("a.hpp");
    const ino_t b = inode("b.hpp");
    const auto written = std::filesystem::last_write_time(path() + "/b.hpp");
    EXPECT_TRUE(write_model(model("a\n", false), path()).empty());
    EXPECT_EQ(inode("a.hpp"), a);
    EXPECT_EQ(write_model(model("new\n", false), path()), (lines{"a.hpp"}));
    EXPECT_NE(inode("a.hpp"), a);  // renamed over, so that a reader sees the old or the new file, never half of one
    EXPECT_EQ(inode("b.hpp"), b);
    EXPECT_EQ(std::filesystem::last_write_time(path() + "/b.hpp"), written);
}

TEST_F(ModelFolder, WhatAnEarlierModelLeftIsRemovedAndWhatTheUserPutThereStays) {
    write_model(model("a\n", true), path());
    folder_.write("deep/model/notes.txt", "mine\n");
    const lines changed = write_model(model("a\n", false), path());
    EXPECT_NE(std::find(changed.begin(), changed.end(), "extra.hpp"), changed.end());
    EXPECT_FALSE(exists("extra.hpp"));
    EXPECT_TRUE(exists("notes.txt"));
}

TEST_F(ModelFolder, AManifestCannotNameFilesElsewhere) {
    write_model(model("a\n", false), path());
    const std::string outside = folder_.write("deep/precious.txt", "keep\n");
    folder_.write("deep/model/manifest.json",
                  "{\"files\": [\"../precious.txt\", \"" + outside + "\", 7, \"..\", \".\", \"\"]}");
    write_model(model("a\n", false), path());
    EXPECT_TRUE(std::filesystem::exists(outside));
}

TEST_F(ModelFolder, ABrokenManifestIsReplaced) {
    for (const char* text : {"", "not json", "[]", "{\"files\": 3}", "{\"files\": {\"a\": 1}}"}) {
        folder_.write("deep/model/manifest.json", text);
        EXPECT_NO_THROW(write_model(model("a\n", false), path())) << text;
        EXPECT_TRUE(compare_model(model("a\n", false), path()).empty()) << text;
    }
}

TEST_F(ModelFolder, ComparisonNamesWhatDiffersIsMissingOrLeftOver) {
    write_model(model("a\n", true), path());
    EXPECT_TRUE(compare_model(model("a\n", true), path()).empty());
    folder_.write("deep/model/a.hpp", "edited\n");
    std::filesystem::remove(path() + "/b.hpp");
    lines found;
    for (const folder_difference& difference : compare_model(model("a\n", false), path())) {
        found.push_back(difference.name + ": " + difference.state());
    }
    EXPECT_EQ(found, (lines{"a.hpp: differs", "b.hpp: missing", "manifest.json: differs", "extra.hpp: left over"}));
    EXPECT_EQ(test::read_text(path() + "/a.hpp"), "edited\n");
    EXPECT_FALSE(exists("b.hpp"));
}

TEST_F(ModelFolder, ComparisonHasBothTexts) {
    write_model(model("a\n", true), path());
    folder_.write("deep/model/a.hpp", "edited\n");
    std::filesystem::remove(path() + "/b.hpp");
    const std::vector<folder_difference> found = compare_model(model("a\n", false), path());
    ASSERT_EQ(found.size(), 4u);
    EXPECT_EQ(found[0].present, "edited\n");
    EXPECT_EQ(found[0].wanted, "a\n");
    EXPECT_EQ(found[1].present, std::nullopt);
    EXPECT_EQ(found[1].wanted, "b\n");
    EXPECT_EQ(found[3].present, "extra\n");
    EXPECT_EQ(found[3].wanted, std::nullopt);
}

TEST_F(ModelFolder, APipeInThePlaceOfAFileIsAMissingFile) {
    write_model(model("a\n", false), path());
    std::filesystem::remove(path() + "/b.hpp");
    ASSERT_EQ(mkfifo((path() + "/b.hpp").c_str(), 0600), 0);
    const std::vector<folder_difference> found = compare_model(model("a\n", false), path());
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].state(), "missing");
}

/// A manifest of this version that lists the named files.
std::string listing(const std::vector<std::string>& names) {
    manifest content;
    content.files = names;
    return to_json_text(content);
}

std::string refusal(const std::string& folder) {
    try {
        read_model(folder);
    } catch (const input_error& error) {
        return error.what();
    }
    return "read";
}

TEST_F(ModelFolder, IsReadBackAsTheManifestListsIt) {
    write_model({{"b.hpp", "b\n"}, {"a.cpp", "a\n"}, {"manifest.json", listing({"b.hpp", "a.cpp"})}}, path());
    folder_.write("deep/model/notes.txt", "mine\n");
    const model_folder read = read_model(path());
    ASSERT_EQ(read.files.size(), 2u);
    EXPECT_EQ(read.files[0].name, "b.hpp");
    EXPECT_EQ(read.files[0].text, "b\n");
    EXPECT_EQ(read.files[1].text, "a\n");
}

TEST_F(ModelFolder, FoldersThatAreNoneOfOursAreRefused) {
    std::filesystem::create_directories(path());
    EXPECT_EQ(refusal(path()), path() + "/manifest.json: missing, expected a folder that idim generate wrote");
    folder_.write("deep/model/manifest.json", listing({"a.hpp"}));
    EXPECT_EQ(refusal(path()), path() + "/a.hpp: missing, though manifest.json lists it: regenerate the folder");
    ASSERT_EQ(mkfifo((path() + "/a.hpp").c_str(), 0600), 0);
    EXPECT_EQ(refusal(path()), path() + "/a.hpp: missing, though manifest.json lists it: regenerate the folder");
    const std::string outside = folder_.write("deep/precious.txt", "keep\n");
    for (const std::string& name : {std::string("../precious.txt"), outside, std::string(".."), std::string(""),
                                    std::string("-rf"), std::string("a b.hpp")}) {
        folder_.write("deep/model/manifest.json", listing({name}));
        EXPECT_EQ(refusal(path()), path() + "/manifest.json: files: expected plain file names") << name;
    }
}

TEST_F(ModelFolder, AFileTooLargeToBeGeneratedIsRefusedUnread) {
    folder_.write("deep/model/manifest.json", listing({"a.hpp"}));
    folder_.write("deep/model/a.hpp", "");
    std::filesystem::resize_file(path() + "/a.hpp", (64ULL << 20U) + 1);  // sparse
    EXPECT_EQ(refusal(path()), path() + "/a.hpp: more than 64 MiB: no generated file");
}

TEST_F(ModelFolder, AFileInItsPlaceIsBadInput) {
    folder_.write("deep", "a file\n");
    EXPECT_THROW(write_model(model("a\n", false), path()), input_error);
}

}  // namespace

}  // namespace idim::generator
