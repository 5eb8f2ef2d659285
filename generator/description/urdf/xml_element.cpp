#include "description/urdf/xml_element.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

constexpr std::string_view spaces = " \t\r\n";
constexpr std::string_view ends_of_name = " \t\r\n=/><\"'&";
constexpr std::array<std::pair<std::string_view, char>, 5> entities = {
    {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};

enum class name_part { none, inside, start };

/// Where a character may stand in a name; bytes of other alphabets are not told apart.
name_part place_in_name(char c) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':';
    if (is_letter || static_cast<unsigned char>(c) >= 0x80) {
        return name_part::start;
    }
    return (c >= '0' && c <= '9') || c == '-' || c == '.' ? name_part::inside : name_part::none;
}

class xml_scanner {
  public:
    xml_scanner(std::string_view text, const std::string& file, const xml_limits& limits)
        : text_(text), file_(file), limits_(limits) {}

    xml_element run() {
        skip_byte_order_mark();
        while (to_next_tag()) {
            if (starts_with("<!--")) {
                skip_past("-->", "a comment");
            } else if (starts_with("<?")) {
                skip_past("?>", "a processing instruction");
            } else if (starts_with("<![CDATA[") && !open_.empty()) {
                skip_past("]]>", "character data");
            } else if (starts_with("<!")) {
                fail("document types and entities are not read, expected elements only");
            } else if (starts_with("</")) {
                read_end();
            } else {
                read_start();
            }
        }
        if (!open_.empty()) {
            throw input_error({file_, open_.back().line, ""},
                              "not XML: element " + quote(open_.back().name) + " is not closed");
        }
        if (!has_root_) {
            throw input_error({file_, 0, ""}, "not XML: expected an element such as <robot name=\"...\">");
        }
        return std::move(root_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw input_error({file_, line_, ""}, message); }

    bool starts_with(std::string_view prefix) const { return text_.substr(at_).starts_with(prefix); }

    void move_to(std::size_t position) {
        line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                             text_.begin() + static_cast<std::ptrdiff_t>(position), '\n'));
        at_ = position;
    }

    void skip_byte_order_mark() { at_ = starts_with("\xef\xbb\xbf") ? 3 : 0; }

    void skip_spaces() { move_to(std::min(text_.find_first_not_of(spaces, at_), text_.size())); }

    void skip_past(std::string_view end, const char* what) {
        const std::size_t found = text_.find(end, at_);
        if (found == std::string_view::npos) {
            fail(std::string("not XML: ") + what + " does not end");
        }
        move_to(found + end.size());
    }

    /// Passes over text. False at the end of the file.
    bool to_next_tag() {
        const std::size_t tag = std::min(text_.find('<', at_), text_.size());
        const std::size_t written = text_.find_first_not_of(spaces, at_);
        if (open_.empty() && written < tag) {
            move_to(written);
            fail("not XML: text outside of elements, expected <robot name=\"...\">");
        }
        move_to(tag);
        return at_ < text_.size();
    }

    char next(const char* expected) const {
        if (at_ >= text_.size()) {
            fail(fmt::format("not XML: the file ends, expected {}", expected));
        }
        return text_[at_];
    }

    std::string read_name(const char* expected) {
        const std::size_t end = std::min(text_.find_first_of(ends_of_name, at_), text_.size());
        std::string name(text_.substr(at_, end - at_));
        if (name.empty()) {
            fail(std::string("not XML: expected ") + expected);
        }
        if (place_in_name(name.front()) != name_part::start ||
            !std::all_of(name.begin(), name.end(), [](char c) { return place_in_name(c) != name_part::none; })) {
            fail("not XML: " + quote(name) + " is no name, expected " + expected);
        }
        move_to(end);
        return name;
    }

    void read_end() {
        move_to(at_ + 2);
        const std::string name = read_name("the name of an element");
        skip_spaces();
        if (open_.empty() || name != open_.back().name || next(">") != '>') {
            fail("not XML: " + quote("</" + name + ">") + " does not close " +
                 (open_.empty() ? "any element"
                                : quote(open_.back().name) + " of line " + std::to_string(open_.back().line)));
        }
        move_to(at_ + 1);
        close();
    }

    void read_start() {
        const int line = line_;
        move_to(at_ + 1);
        open_.push_back({read_name("the name of an element"), line, {}, {}});
        check_limits();
        for (skip_spaces(); next(">") != '>' && next(">") != '/'; skip_spaces()) {
            read_attribute(open_.back());
        }
        const bool is_empty = text_[at_] == '/';
        move_to(at_ + (is_empty ? 1 : 0));
        if (next(">") != '>') {
            fail("not XML: expected /> at the end of element " + quote(open_.back().name));
        }
        move_to(at_ + 1);
        if (is_empty) {
            close();
        }
    }

    void close() {
        xml_element element = std::move(open_.back());
        open_.pop_back();
        if (!open_.empty()) {
            open_.back().children.push_back(std::move(element));
        } else if (has_root_) {
            fail("not XML: a second root element " + quote(element.name));
        } else {
            root_ = std::move(element);
            has_root_ = true;
        }
    }

    void check_limits() {
        count_ += 1;
        counted_ += open_.back().name == limits_.counted_name ? 1 : 0;
        if (open_.size() > limits_.depth) {
            fail("elements nested more than " + std::to_string(limits_.depth) + " deep");
        }
        if (counted_ > limits_.counted) {
            fail("more than " + std::to_string(limits_.counted) + " elements " + quote(limits_.counted_name));
        }
        if (count_ > limits_.elements) {
            fail("more than " + std::to_string(limits_.elements) + " elements");
        }
    }

    void read_attribute(xml_element& element) {
        const std::string name = read_name("an attribute, > or />");
        if (element.attribute(name) != nullptr) {
            fail("not XML: attribute " + quote(name) + " comes twice");
        }
        if (element.attributes.size() == limits_.attributes) {
            fail("element " + quote(element.name) + " has more than " + std::to_string(limits_.attributes) +
                 " attributes");
        }
        skip_spaces();
        if (next("=") != '=') {
            fail("not XML: expected = after attribute " + quote(name));
        }
        move_to(at_ + 1);
        skip_spaces();
        const char mark = next("a quoted value");
        const std::size_t end = mark == '"' || mark == '\'' ? text_.find(mark, at_ + 1) : std::string_view::npos;
        if (end == std::string_view::npos) {
            fail("not XML: expected a value in quotes for attribute " + quote(name));
        }
        element.attributes.emplace_back(name, value_of(text_.substr(at_ + 1, end - at_ - 1)));
        move_to(end + 1);
    }

    /// Entities resolved, white space as spaces.
    std::string value_of(std::string_view written) const {
        std::string value;
        for (std::size_t at = 0; at < written.size();) {
            const std::string_view rest = written.substr(at);
            const auto entity = std::find_if(entities.begin(), entities.end(),
                                             [rest](const auto& known) { return rest.starts_with(known.first); });
            if (entity != entities.end()) {
                value += entity->second;
                at += entity->first.size();
                continue;
            }
            if (rest.front() == '<' || rest.front() == '&') {
                fail("not XML: " + quote(rest.substr(0, 1)) +
                     " in a value, expected &lt; or one of the entities &amp;" + " &lt; &gt; &quot; &apos;");
            }
            value += spaces.find(rest.front()) == std::string_view::npos ? rest.front() : ' ';
            ++at;
        }
        return value;
    }

    std::string_view text_;
    const std::string& file_;
    const xml_limits& limits_;
    std::size_t at_ = 0;
    int line_ = 1;
    std::size_t count_ = 0;
    std::size_t counted_ = 0;
    std::vector<xml_element> open_;
    xml_element root_;
    bool has_root_ = false;
};

std::string escaped(const std::string& value) {
    std::string text;
    for (const char c : value) {
        const auto entity =
            std::find_if(entities.begin(), entities.end(), [c](const auto& known) { return known.second == c; });
        text += entity == entities.end() ? std::string(1, c) : std::string(entity->first);
    }
    return text;
}

}  // namespace

const std::string* xml_element::attribute(std::string_view attribute_name) const {
    const auto found = std::find_if(attributes.begin(), attributes.end(),
                                    [attribute_name](const auto& entry) { return entry.first == attribute_name; });
    return found == attributes.end() ? nullptr : &found->second;
}

const xml_element* xml_element::child(std::string_view child_name) const {
    const auto found = std::find_if(children.begin(), children.end(),
                                    [child_name](const xml_element& element) { return element.name == child_name; });
    return found == children.end() ? nullptr : &*found;
}

xml_element read_xml(const std::string& text, const std::string& file, const xml_limits& limits) {
    return xml_scanner(text, file, limits).run();
}

std::string to_string(const xml_element& element) {
    std::string text = "<" + element.name;
    for (const auto& [name, value] : element.attributes) {
        text += " " + name + "=\"" + escaped(value) + "\"";
    }
    text += element.children.empty() ? "/>" : ">";
    for (const xml_element& child : element.children) {
        text += to_string(child);
    }
    return text + (element.children.empty() ? "" : "</" + element.name + ">");
}

}  // namespace idim::generator
