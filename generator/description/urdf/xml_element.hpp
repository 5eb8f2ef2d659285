#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace idim::generator {

/// An element of an XML file with the line it starts on. Text between elements is not kept.
struct xml_element {
    std::string name;
    int line = 0;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<xml_element> children;

    /// Null if there is none.
    const std::string* attribute(std::string_view attribute_name) const;
    /// The first child of that name, null if there is none.
    const xml_element* child(std::string_view child_name) const;
};

/// What a file may hold at most. A file beyond one of these is refused as soon as the limit is passed, with its name.
struct xml_limits {
    std::size_t depth;       ///< of elements in one another
    std::size_t elements;    ///< in all
    std::size_t attributes;  ///< of one element
    std::string_view counted_name;
    std::size_t counted;  ///< elements named `counted_name`
};

inline constexpr xml_limits urdf_limits = {32, 100'000, 64, "link", 2000};

/// The root element of the XML in `text`; `file` is named in messages. One pass from the first character to the last.
/// Throws input_error with the line where the text is not well formed, holds a document type (so no entity is ever
/// declared or expanded) or passes a limit.
xml_element read_xml(const std::string& text, const std::string& file, const xml_limits& limits);

/// XML text of an element with its attributes and children.
std::string to_string(const xml_element& element);

}  // namespace idim::generator
