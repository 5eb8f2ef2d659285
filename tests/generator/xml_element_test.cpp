#include "description/urdf/xml_element.hpp"

#include <gtest/gtest.h>

#include "idim/input_error.hpp"

namespace idim::generator {

namespace {

constexpr xml_limits small = {3, 10, 2, "link", 2};

std::string error_of_xml(const std::string& text) {
    try {
        read_xml(text, "f", small);
    } catch (const input_error& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST(XmlElement, KeepsNamesAttributesChildrenAndLines) {
    const xml_element root = read_xml(
        "\xef\xbb\xbf<?xml version='1.0'?>\n<!-- <a> -->\n<robot name = \"a &lt;b&amp;c\"\n x='1\n2'>text\n"
        "<link/><![CDATA[ </robot> ]]>\n<joint></joint ></robot>\n<!-- end -->\n",
        "f", small);
    EXPECT_EQ(root.name, "robot");
    EXPECT_EQ(root.line, 3);
    EXPECT_EQ(*root.attribute("name"), "a <b&c");
    EXPECT_EQ(*root.attribute("x"), "1 2");
    EXPECT_EQ(root.attribute("y"), nullptr);
    ASSERT_EQ(root.children.size(), 2u);
    EXPECT_EQ(root.children[0].line, 6);
    EXPECT_EQ(root.child("joint")->line, 7);
    EXPECT_EQ(to_string(root), "<robot name=\"a &lt;b&amp;c\" x=\"1 2\"><link/><joint/></robot>");
}

TEST(XmlElement, RefusesWhatIsNotWellFormedWithItsLine) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "f: not XML: expected an element"},
        {"<!-- x -->\n", "f: not XML: expected an element"},
        {"a\n", "f:1: not XML: text outside of elements"},
        {"<a/>\nb", "f:2: not XML: text outside of elements"},
        {"<a>\n<b>\n</a>", "f:3: not XML: \"</a>\" does not close \"b\" of line 2"},
        {"</a>", "f:1: not XML: \"</a>\" does not close any element"},
        {"\n<a>", "f:2: not XML: element \"a\" is not closed"},
        {"<a\nb", "f:2: not XML: the file ends, expected ="},
        {"<a b=c/>", "f:1: not XML: expected a value in quotes for attribute \"b\""},
        {"<a b='1' b='2'/>", "f:1: not XML: attribute \"b\" comes twice"},
        {"<a b='\"", "f:1: not XML: expected a value in quotes"},
        {"<a b='<'/>", "f:1: not XML: \"<\" in a value"},
        {"<a b='&x;'/>", "f:1: not XML: \"&\" in a value"},
        {"<a / b>", "f:1: not XML: expected />"},
        {"< a/>", "f:1: not XML: expected the name of an element"},
        {"<a 1b='1'/>", "f:1: not XML: \"1b\" is no name, expected an attribute"},
        {"<a,b/>", "f:1: not XML: \"a,b\" is no name, expected the name of an element"},
        {"<a/><b/>", "f:1: not XML: a second root element \"b\""},
        {"<a>\n<!-- ", "f:2: not XML: a comment does not end"},
        {"<a><![CDATA[", "f:1: not XML: character data does not end"},
        {"<a>\n<", "f:2: not XML: expected the name of an element"},
    };
    for (const auto& [text, message] : cases) {
        EXPECT_EQ(error_of_xml(text).rfind(message, 0), 0u) << text << ": " << error_of_xml(text);
    }
}

TEST(XmlElement, RefusesDocumentTypesSoThatNoEntityIsExpanded) {
    const std::string message = "f:2: document types and entities are not read, expected elements only";
    EXPECT_EQ(error_of_xml("<?xml version='1.0'?>\n<!DOCTYPE a [<!ENTITY b 'bb'>]><a/>"), message);
    EXPECT_EQ(error_of_xml("<a>\n<!ENTITY b 'bb'></a>"), message);
}

TEST(XmlElement, NamesTheLimitThatAFilePasses) {
    EXPECT_EQ(error_of_xml("<a>\n<a>\n<a>\n<a>\n"), "f:4: elements nested more than 3 deep");
    EXPECT_EQ(error_of_xml("<a><link/><link/>\n<link/></a>"), "f:2: more than 2 elements \"link\"");
    EXPECT_EQ(error_of_xml("<a><b/><b/><b/><b/><b/><b/><b/><b/><b/>\n<b/></a>"), "f:2: more than 10 elements");
    EXPECT_EQ(error_of_xml("<a b='1' c='2' d='3'/>"), "f:1: element \"a\" has more than 2 attributes");
}

}  // namespace idim::generator
