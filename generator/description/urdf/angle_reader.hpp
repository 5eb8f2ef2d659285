#pragma once

#include <string>
#include <utility>
#include <vector>

#include "idim/input_error.hpp"

namespace idim::generator {

/// Reads the angles of one file, and remembers those that are not taken as written, or nearly were not.
class angle_reader {
  public:
    /// The angle [rad] that `text` stands for: a multiple of pi/2 where written_angle sees one. Throws input_error
    /// where it is no finite number.
    double read(const std::string& text, const input_location& where);

    /// Which angles became multiples of pi/2 (but for those that are one to double precision), and which have too few
    /// decimals for it, with their lines.
    std::vector<std::string> notes() const;

  private:
    using lines_of = std::vector<std::pair<std::string, std::vector<int>>>;

    static void note(lines_of& list, const std::string& text, int line);
    static std::string listed(const lines_of& list);

    lines_of rounded_, nearly_;
};

}  // namespace idim::generator
