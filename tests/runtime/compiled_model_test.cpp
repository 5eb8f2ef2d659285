#include "idim/compiled_model.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/temporary_folder.hpp"

namespace idim {
namespace {

namespace fs = std::filesystem;

const std::string hash = "0123456789abcdef";

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

/// A model without joints, its name kept in an inline variable as generated models keep theirs.
std::vector<model_source> model_named(const std::string& robot, const std::string& input_hash = hash) {
    const std::string body = R"(
#include "idim/model_interface.h"
#include "robot.hpp"
inline constexpr const char* joint_names[] = {ROBOT};
extern "C" const idim_model_interface* idim_model(void) {
    static idim_model_interface model{};
    model.abi = MODEL_ABI;
    model.robot = ROBOT;
    model.input_hash = INPUT_HASH;
    model.joint_names = joint_names;
    return &model;
}
)";
    const std::string header = "#define MODEL_ABI IDIM_MODEL_ABI\n#define ROBOT \"" + robot +
                               "\"\n#define INPUT_HASH \"" + input_hash + "\"\n";
    const std::string interface = content_of(IDIM_SOURCE_DIR "/runtime/include/idim/model_interface.h");
    return {{"model.cpp", body}, {"robot.hpp", header}, {"idim/model_interface.h", interface}};
}

/// Gives an environment variable another value, or none, until the end of the scope.
class environment_change {
  public:
    environment_change(const char* name, const char* value) : name_(name) {
        if (const char* const old = getenv(name)) {
            old_ = old;
        }
        set(value);
    }
    ~environment_change() { set(old_ ? old_->c_str() : nullptr); }
    environment_change(const environment_change&) = delete;
    environment_change& operator=(const environment_change&) = delete;

  private:
    void set(const char* value) {
        if (value == nullptr) {
            unsetenv(name_);
        } else {
            setenv(name_, value, 1);
        }
    }

    const char* name_;
    std::optional<std::string> old_;
};

class CompiledModel : public testing::Test {
  protected:
    CompiledModel() {
        options_.cache = (folder_.path() / "cache").string();
        options_.compiler = counting_compiler("compiler");
    }

    /// The system's compiler behind a script that notes each compilation, which it delays by `seconds`.
    std::string counting_compiler(const std::string& name, const std::string& seconds = "0") {
        const std::string script = "#!/bin/sh\ncase \"$*\" in *-shared*) sleep " + seconds + "; echo x >> '" +
                                   count_file().string() + "';; esac\nexec c++ \"$@\"\n";
        const std::string file = folder_.write(name, script);
        fs::permissions(file, fs::perms::owner_all);
        return file;
    }

    fs::path count_file() const { return folder_.path() / "count"; }
    size_t compilations() const { return content_of(count_file()).size() / 2; }

    std::vector<fs::path> entries() const {
        std::vector<fs::path> found;
        for (const fs::directory_entry& file : fs::directory_iterator(options_.cache)) {
            if (file.is_directory()) {
                found.push_back(file.path());
            }
        }
        return found;
    }
    fs::path entry() const { return entries().at(0); }

    std::string robot() const { return compile_model(sources_, hash, options_).interface().robot; }

    std::string message_of_failure(const std::vector<model_source>& sources, const std::string& input_hash) const {
        try {
            compile_model(sources, input_hash, options_);
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "no failure";
    }

    /// Compiles, lets `damage` spoil the entry, and expects that the next call compiles once more and that the one
    /// after finds a whole entry again.
    void expect_rebuilt_after(const std::function<void()>& damage) {
        EXPECT_EQ(robot(), "one");
        ASSERT_EQ(compilations(), 1u);
        damage();
        EXPECT_EQ(robot(), "one");
        EXPECT_EQ(compilations(), 2u);
        EXPECT_EQ(robot(), "one");
        EXPECT_EQ(compilations(), 2u);
        EXPECT_EQ(entries().size(), 1u);
    }

    /// Expects that the model compiles though the cache is out of use, and that the folder used instead is gone.
    void expect_compiled_elsewhere() const {
        const test::temporary_folder elsewhere;
        const environment_change temporary("TMPDIR", elsewhere.path().c_str());
        EXPECT_EQ(robot(), "one");
        EXPECT_EQ(compilations(), 1u);
        EXPECT_TRUE(fs::is_empty(elsewhere.path()));
    }

    test::temporary_folder folder_;
    compile_options options_;
    std::vector<model_source> sources_ = model_named("one");
};

TEST_F(CompiledModel, SecondCallTakesTheEntryAndDoesNotCompile) {
    EXPECT_EQ(robot(), "one");
    EXPECT_EQ(robot(), "one");
    EXPECT_EQ(compilations(), 1u);
    EXPECT_EQ(content_of(entry() / "idim/model_interface.h"), sources_[2].text);
}

TEST_F(CompiledModel, CacheIsForThisUserAloneWhateverTheUmask) {
    const mode_t old = umask(0);
    EXPECT_EQ(robot(), "one");
    EXPECT_EQ(robot(), "one");
    umask(old);
    EXPECT_EQ(compilations(), 1u);
    const fs::perms others = fs::perms::group_all | fs::perms::others_all;
    EXPECT_EQ(fs::status(options_.cache).permissions(), fs::perms::owner_all);
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(options_.cache)) {
        EXPECT_EQ(file.status().permissions() & others, fs::perms::none) << file.path();
    }
}

TEST_F(CompiledModel, TruncatedLibraryIsRebuilt) {
    expect_rebuilt_after([&] { fs::resize_file(entry() / "model.so", 1000); });
}

TEST_F(CompiledModel, LibraryOfAnotherModelIsRebuilt) {
    compile_options elsewhere = options_;
    elsewhere.cache = (folder_.path() / "other").string();
    expect_rebuilt_after([&] {
        options_.cache.swap(elsewhere.cache);
        compile_model(model_named("two"), hash, options_);
        const std::string other = content_of(entry() / "model.so");
        options_.cache.swap(elsewhere.cache);
        fs::remove(count_file());
        write(count_file(), "x\n");
        write(entry() / "model.so", other);
    });
}

TEST_F(CompiledModel, LibraryRemovedWhileTheModelIsInUseDoesNoHarm) {
    const compiled_model model = compile_model(sources_, hash, options_);
    fs::resize_file(entry() / "model.so", 0);
    EXPECT_EQ(robot(), "one");
    fs::remove_all(options_.cache);
    EXPECT_STREQ(model.interface().robot, "one");
}

TEST_F(CompiledModel, EditedSourceIsRebuilt) {
    expect_rebuilt_after([&] { write(entry() / "robot.hpp", sources_[1].text + "\n"); });
}

TEST_F(CompiledModel, MissingRecordIsRebuilt) {
    expect_rebuilt_after([&] { fs::remove(entry() / "model.sha256"); });
}

TEST_F(CompiledModel, EntryThatOthersMayWriteIsRebuilt) {
    expect_rebuilt_after([&] { fs::permissions(entry(), fs::perms::all); });
}

TEST_F(CompiledModel, FolderInTheEntryThatTheGroupMayWriteIsRebuilt) {
    expect_rebuilt_after([&] { fs::permissions(entry() / "idim", fs::perms::group_write, fs::perm_options::add); });
}

TEST_F(CompiledModel, FileThatOthersMayWriteIsRebuilt) {
    expect_rebuilt_after(
        [&] { fs::permissions(entry() / "model.so", fs::perms::others_write, fs::perm_options::add); });
}

TEST_F(CompiledModel, LinkInPlaceOfTheEntryIsRebuiltAndItsTargetKept) {
    const fs::path target = folder_.path() / "target";
    expect_rebuilt_after([&] {
        const fs::path link = entry();
        fs::rename(link, target);
        fs::create_directory_symlink(target, link);
    });
    EXPECT_FALSE(fs::is_symlink(entry()));
    EXPECT_TRUE(fs::exists(target / "model.so"));
}

TEST_F(CompiledModel, LinkInPlaceOfTheLibraryIsRebuilt) {
    expect_rebuilt_after([&] {
        const fs::path link = entry() / "model.so";
        fs::rename(link, folder_.path() / "target.so");
        fs::create_symlink(folder_.path() / "target.so", link);
    });
}

TEST_F(CompiledModel, PipeInPlaceOfTheLibraryIsRebuilt) {
    expect_rebuilt_after([&] {
        fs::remove(entry() / "model.so");
        ASSERT_EQ(mkfifo((entry() / "model.so").c_str(), 0600), 0);
    });
}

TEST_F(CompiledModel, FileOfAnotherUserIsRebuilt) {
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can give files away";
    }
    expect_rebuilt_after([&] { ASSERT_EQ(chown((entry() / "model.so").c_str(), 65534, 65534), 0); });
}

TEST_F(CompiledModel, AbandonedBuildIsRemoved) {
    fs::path abandoned;
    expect_rebuilt_after([&] {
        abandoned = entry().string() + ".build-AAAAAA";
        fs::rename(entry(), abandoned);
    });
    EXPECT_FALSE(fs::exists(abandoned));
}

TEST_F(CompiledModel, AnotherCompilerGivesAnotherEntry) {
    EXPECT_EQ(robot(), "one");
    options_.compiler = counting_compiler("another_compiler");
    EXPECT_EQ(robot(), "one");
    EXPECT_EQ(compilations(), 2u);
    EXPECT_EQ(entries().size(), 2u);
}

TEST_F(CompiledModel, CompilerOfTheEnvironmentMayHaveArguments) {
    const std::string compiler = options_.compiler + "  -DIDIM_UNUSED ";
    options_.compiler.clear();
    const environment_change variable("CXX", compiler.c_str());
    EXPECT_EQ(robot(), "one");
    EXPECT_EQ(compilations(), 1u);
    const environment_change another("CXX", (compiler + "-DIDIM_OTHER").c_str());
    EXPECT_EQ(robot(), "one");
    EXPECT_EQ(compilations(), 2u);
}

TEST_F(CompiledModel, CompilerPathMayHoldBlanks) {
    options_.compiler = counting_compiler("a compiler");
    EXPECT_EQ(robot(), "one");
    EXPECT_EQ(compilations(), 1u);
}

TEST_F(CompiledModel, MissingCompilerIsNamed) {
    options_.compiler = "no_such_compiler -O2";
    EXPECT_NE(message_of_failure(sources_, hash).find("there is no compiler 'no_such_compiler'"), std::string::npos);
}

TEST_F(CompiledModel, NoCompilerOnThePathIsSaid) {
    options_.compiler.clear();
    const environment_change variable("CXX", nullptr);
    const environment_change path("PATH", folder_.path().c_str());
    EXPECT_NE(message_of_failure(sources_, hash).find("none of c++, g++, clang++ is on the PATH"), std::string::npos);
}

TEST_F(CompiledModel, ProgramThatCompilesNothingIsReported) {
    options_.compiler = "true";
    EXPECT_NE(message_of_failure(sources_, hash).find("the compiler wrote no model.so"), std::string::npos);
}

TEST_F(CompiledModel, CompileErrorShowsMessageAndCommandAndLeavesNoEntry) {
    std::vector<model_source> sources = model_named("one");
    sources[0].text += "undeclared_type value;\n";
    const std::string message = message_of_failure(sources, hash);
    EXPECT_NE(message.find("undeclared_type"), std::string::npos) << message;
    EXPECT_NE(message.find("command: " + options_.compiler + " -std=c++17"), std::string::npos) << message;
    EXPECT_TRUE(entries().empty());
}

TEST_F(CompiledModel, WarningIsACompileError) {
    std::vector<model_source> sources = model_named("one");
    sources[0].text += "static void unused_function() {}\n";
    EXPECT_NE(message_of_failure(sources, hash).find("unused_function"), std::string::npos);
}

TEST_F(CompiledModel, WrongInputHashIsReported) {
    const std::string message = message_of_failure(sources_, "fedcba9876543210");
    EXPECT_EQ(message, "the compiled model cannot be used: its input hash is '" + hash + "', not 'fedcba9876543210'");
    EXPECT_TRUE(entries().empty());
}

TEST_F(CompiledModel, WrongAbiIsReported) {
    sources_[1].text.replace(sources_[1].text.find(" IDIM_MODEL_ABI"), 15, " 99");
    EXPECT_NE(message_of_failure(sources_, hash).find("its interface is version 99"), std::string::npos);
}

TEST_F(CompiledModel, LibraryWithoutTheHandshakeIsReported) {
    const std::vector<model_source> sources = {{"model.cpp", "int other() { return 0; }\n"}};
    EXPECT_NE(message_of_failure(sources, hash).find("it has no function idim_model"), std::string::npos);
}

TEST_F(CompiledModel, UnresolvedSymbolIsReportedOnLoading) {
    sources_[0].text += "void nowhere(); void use_it() { nowhere(); }\n";
    EXPECT_NE(message_of_failure(sources_, hash).find("undefined symbol"), std::string::npos);
}

TEST_F(CompiledModel, SourceOutsideTheFolderIsALogicError) {
    for (const char* name : {"../x.hpp", "/tmp/x.hpp", "a/../../x.hpp", "", ".", "..", "a/", "./x.hpp", "a//x.hpp",
                             "model.so", "model.sha256", "model.exports", "model.cpp"}) {
        std::vector<model_source> sources = sources_;
        sources.push_back({name, ""});
        EXPECT_THROW(compile_model(sources, hash, options_), std::logic_error) << name;
    }
    EXPECT_THROW(compile_model({{"x.hpp", ""}}, hash, options_), std::logic_error);
    EXPECT_FALSE(fs::exists(options_.cache));
}

// g++ makes an inline variable a symbol that is one for the whole process (STB_GNU_UNIQUE).
TEST_F(CompiledModel, ModelsLoadedTogetherDoNotShareInlineVariables) {
    const compiled_model one = compile_model(sources_, hash, options_);
    const compiled_model two = compile_model(model_named("two"), hash, options_);
    const compiled_model again = compile_model(sources_, hash, options_);
    EXPECT_STREQ(one.interface().joint_names[0], "one");
    EXPECT_STREQ(two.interface().joint_names[0], "two");
    EXPECT_STREQ(again.interface().joint_names[0], "one");
}

TEST_F(CompiledModel, LibraryThatCannotBeUnloadedIsNotTakenForTheNext) {
    options_.compiler += " -Wl,-z,nodelete";
    EXPECT_EQ(robot(), "one");
    EXPECT_STREQ(compile_model(model_named("two"), hash, options_).interface().robot, "two");
}

TEST_F(CompiledModel, TwoProcessesAtOnceCompileOnceAndShareTheEntry) {
    options_.compiler = counting_compiler("slow_compiler", "0.5");
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        _exit(message_of_failure(sources_, hash) == "no failure" ? 0 : 1);
    }
    EXPECT_EQ(robot(), "one");
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT_EQ(compilations(), 1u);
    EXPECT_EQ(entries().size(), 1u);
}

TEST_F(CompiledModel, CacheThatCannotBeMadeFallsBack) {
    options_.cache = folder_.write("file", "") + "/cache";
    expect_compiled_elsewhere();
}

TEST_F(CompiledModel, CacheThatCannotBeWrittenFallsBack) {
    if (geteuid() == 0) {
        GTEST_SKIP() << "root may write everywhere";
    }
    fs::create_directory(options_.cache);
    fs::permissions(options_.cache, fs::perms::owner_read | fs::perms::owner_exec);
    expect_compiled_elsewhere();
    fs::permissions(options_.cache, fs::perms::owner_all);
}

TEST_F(CompiledModel, CacheThatOthersMayWriteIsLeftAlone) {
    fs::create_directory(options_.cache);
    fs::permissions(options_.cache, fs::perms::all);
    expect_compiled_elsewhere();
    EXPECT_TRUE(fs::is_empty(options_.cache));
}

TEST_F(CompiledModel, CacheOfAnotherUserIsLeftAlone) {
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can give folders away";
    }
    fs::create_directory(options_.cache);
    ASSERT_EQ(chown(options_.cache.c_str(), 65534, 65534), 0);
    expect_compiled_elsewhere();
    EXPECT_TRUE(fs::is_empty(options_.cache));
}

TEST_F(CompiledModel, LinkInPlaceOfTheCacheIsLeftAlone) {
    fs::create_directory(folder_.path() / "target");
    fs::create_directory_symlink(folder_.path() / "target", options_.cache);
    options_.cache += "/";
    expect_compiled_elsewhere();
    EXPECT_TRUE(fs::is_empty(folder_.path() / "target"));
}

TEST_F(CompiledModel, LockThatCannotBeOpenedFallsBack) {
    EXPECT_EQ(robot(), "one");
    const fs::path lock = entry().string() + ".lock";
    fs::remove(lock);
    fs::create_directory(lock);
    fs::remove(count_file());
    expect_compiled_elsewhere();
}

TEST_F(CompiledModel, DefaultCacheIsThatOfTheXdgVariableThenOfHome) {
    options_.cache.clear();
    const environment_change home("HOME", folder_.path().c_str());
    const environment_change xdg("XDG_CACHE_HOME", (folder_.path() / "xdg").c_str());
    EXPECT_EQ(robot(), "one");
    EXPECT_TRUE(fs::exists(folder_.path() / "xdg" / "idim"));
    EXPECT_FALSE(fs::exists(folder_.path() / ".cache"));
    const environment_change relative("XDG_CACHE_HOME", "relative");
    EXPECT_EQ(robot(), "one");
    EXPECT_TRUE(fs::exists(folder_.path() / ".cache" / "idim"));
}

TEST_F(CompiledModel, WithoutVariablesTheFolderIsPrivateAndGoneAfterwards) {
    options_.cache.clear();
    const environment_change home("HOME", (folder_.path() / "nonexistent").c_str());
    const environment_change xdg("XDG_CACHE_HOME", nullptr);
    expect_compiled_elsewhere();
    EXPECT_FALSE(fs::exists(folder_.path() / "nonexistent"));
}

}  // namespace
}  // namespace idim
