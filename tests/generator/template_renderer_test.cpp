#include "emit/template_renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "support/robot_files.hpp"

namespace idim::generator {

namespace {

template_context small_context() {
    template_context context;
    context.robot = "arm";
    context.version = "1.2.3";
    context.robot_file = "arm.yaml";
    context.input_hash = "0123456789abcdef";
    context.constants = {"L = 0.5"};
    context.effects = {"viscous_friction at j1"};
    context.joints = {{"j1", false, 2.5, 3.0, "rad"}};
    context.base_parameters = {{"ZZ1R", "kg*m^2", "ZZ1 + L^2*M1"}};
    context.standard_parameters = {{"ZZ1", "kg*m^2", "ZZ1"}};
    function_context function;
    function.name = "gravity";
    function.summary = "Less than <, more than > and \"quotes\" & ampersands.";
    function.meanings = {"q [1]", "G [1]"};
    const routine_context routine{
        function.summary, function.meanings, "void gravity(const Scalar* q, Scalar* G)", {}, {"G[0] = cos(q[0]);"}};
    function.variants = {{"Scalar", "", false, {routine}}};
    context.functions = {function};
    return context;
}

class TemplateRenderer : public testing::Test {
  protected:
    TemplateRenderer() {
        std::filesystem::copy(test::templates_folder + "/cpp", templates(), std::filesystem::copy_options::recursive);
    }

    std::string templates() const { return (folder_.path() / "cpp").string(); }

    void append(const std::string& name, const std::string& text) const {
        folder_.write("cpp/" + name, test::read_text(templates() + "/" + name) + text);
    }

    std::string error() const {
        try {
            render(small_context(), templates());
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "no error";
    }

    test::temporary_folder folder_;
};

std::string text_of(const std::vector<rendered_file>& files, const std::string& name) {
    const auto found = std::find_if(files.begin(), files.end(), [&](const rendered_file& f) { return f.name == name; });
    return found == files.end() ? "" : found->text;
}

TEST_F(TemplateRenderer, PrintsEveryFunctionWithItsTextAsItIs) {
    const auto files = render(small_context(), templates());
    const std::string gravity = text_of(files, "gravity.hpp");
    EXPECT_NE(gravity.find("Less than <, more than > and \"quotes\" & ampersands."), std::string::npos) << gravity;
    EXPECT_NE(gravity.find("G[0] = cos(q[0]);"), std::string::npos);
    EXPECT_NE(gravity.find("arm.yaml"), std::string::npos);
    for (const rendered_file& file : files) {
        EXPECT_EQ(file.text.find("{{"), std::string::npos) << file.name;
        EXPECT_EQ(file.text.find(templates()), std::string::npos) << file.name;
    }
}

TEST_F(TemplateRenderer, TheHashOfTheInputStandsInOneLineOfOneFile) {
    const std::string hash = small_context().input_hash;
    for (const rendered_file& file : render(small_context(), templates())) {
        const std::size_t at = file.text.find(hash);
        EXPECT_EQ(at != std::string::npos, file.name == "model.hpp") << file.name;
        EXPECT_EQ(at == std::string::npos ? at : file.text.find(hash, at + 1), std::string::npos) << file.name;
    }
}

TEST_F(TemplateRenderer, ARobotWithoutConstantsAndEffectsIsPrinted) {
    template_context context = small_context();
    context.constants.clear();
    context.effects.clear();
    EXPECT_FALSE(text_of(render(context, templates()), "model.hpp").empty());
}

TEST_F(TemplateRenderer, AKeyThatNoOneProvidesIsAnErrorThatNamesIt) {
    for (const char* tag :
         {"{{no_such_key}}", "{{#no_such_key}}{{/no_such_key}}", "{{^no_such_key}}x{{/no_such_key}}"}) {
        append("model.hpp.mustache", tag);
        EXPECT_NE(error().find("no_such_key"), std::string::npos) << error();
        EXPECT_NE(error().find("model.hpp.mustache"), std::string::npos) << error();
    }
}

TEST_F(TemplateRenderer, ATemplateThatIsMalformedIsAnErrorThatNamesIt) {
    append("function.hpp.mustache", "{{#arguments}}");
    EXPECT_NE(error().find("function.hpp.mustache"), std::string::npos) << error();
}

TEST_F(TemplateRenderer, AFolderWithoutTemplatesIsAnErrorThatNamesIt) {
    std::filesystem::remove_all(templates());
    EXPECT_NE(error().find("no templates in " + templates()), std::string::npos) << error();
    std::filesystem::create_directory(templates());
    EXPECT_NE(error().find("no templates in " + templates()), std::string::npos) << error();
}

TEST_F(TemplateRenderer, TheNameOfATemplateSaysWhatItsFilesAreCalled) {
    template_context context = small_context();
    context.functions.front().variants.push_back({"float", "_f", false, {}});
    folder_.write("lang/function.x.mustache", "{{name}} in {{scalar}}\n");
    folder_.write("lang/robot.y.mustache", "{{>head}}\n{{robot}}\n");
    folder_.write("lang/any.z.mustache", "{{n_base}}\n");
    folder_.write("lang/head.mustache", "of {{robot_file}}\n");
    const auto files = render(context, (folder_.path() / "lang").string());
    ASSERT_EQ(files.size(), 4u);
    EXPECT_EQ(text_of(files, "any.z"), "1\n");
    EXPECT_EQ(text_of(files, "gravity.x"), "gravity in Scalar\n");
    EXPECT_EQ(text_of(files, "gravity_f.x"), "gravity in float\n");
    EXPECT_EQ(text_of(files, "arm.y"), "of arm.yaml\narm\n");
}

TEST_F(TemplateRenderer, ASectionThatIsNotPrintedLeavesNoLine) {
    template_context context = small_context();
    context.effects.clear();
    folder_.write("lang/any.z.mustache",
                  "a\n{{#effects}}\n{{text}}\n{{/effects}}\n\n{{#constants}}\n{{text}}\n{{/constants}}\nb\n");
    EXPECT_EQ(text_of(render(context, (folder_.path() / "lang").string()), "any.z"), "a\n\nL = 0.5\nb\n");
}

}  // namespace

}  // namespace idim::generator
