#pragma once

#include <kainjow/mustache.hpp>
#include <set>
#include <string>
#include <vector>

namespace idim::generator {

/// Values for the keys of templates. Remembers every key, so that a key no one provides is an error instead of an empty
/// string.
class context_data {
  public:
    using data = kainjow::mustache::data;

    void set(const std::string& key, const std::string& value) { place(key) = data(value); }
    void set(const std::string& key, const std::vector<context_data>& list);
    void set_flag(const std::string& key, bool value) { place(key) = data(value); }
    /// Lines of a section whose tag is "text"; the tag is known even where there is no line. A body has thousands of
    /// them, which the library would copy and look up one by one, so the section lays them out itself. They are not
    /// copied: they have to live as long as what is filled from them.
    void set_lines(const std::string& key, const std::vector<std::string>& lines);
    /// A partial stands on a line of its own, so its last line break is the template's.
    void set_partial(const std::string& key, std::string text);
    /// The keys of an entry, for a list that may be empty.
    void know(const context_data& entry) { keys_.insert(entry.keys_.begin(), entry.keys_.end()); }

    const data& values() const { return values_; }
    bool has(const std::string& key) const { return keys_.count(key) != 0; }

  private:
    data& place(const std::string& key);

    data values_;
    std::set<std::string> keys_;
};

}  // namespace idim::generator
