#pragma once

#include <string>
#include <vector>

#include "support/urdf_text.hpp"

namespace idim::test {

/// A URDF whose links hang on any earlier one, with joints of random types, origins and axes. Some origins and axes are
/// square to their neighbours, so that parallel, crossing and coincident axes come up; some links have no inertia.
inline std::string random_tree(int links, const std::vector<std::string>& types, std::mt19937_64& random) {
    constexpr double quarter = 1.5707963267948966;
    const auto choice = [&random](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
    const auto square = [&] {
        triple xyz = {0.0, 0.0, 0.0};
        xyz[static_cast<std::size_t>(choice(3))] = choice(2) == 0 ? 0.0 : draw(0.4, random);
        return urdf_origin{xyz, {quarter * (choice(4) - 1), quarter * (choice(4) - 1), quarter * (choice(4) - 1)}};
    };
    const auto along = [&] {
        triple axis = {0.0, 0.0, 0.0};
        axis[static_cast<std::size_t>(choice(3))] = choice(2) == 0 ? 1.0 : -0.5;
        return axis;
    };
    const std::vector<rigid_link> bodies = plausible_links(links, random);
    urdf_text urdf("tree");
    urdf.massless_link("l0");
    for (int l = 1; l <= links; ++l) {
        const std::string number = std::to_string(l);
        if (choice(6) == 0) {
            urdf.massless_link("l" + number);
        } else {
            urdf.link("l" + number, bodies[static_cast<std::size_t>(l - 1)], draw_triple(3.0, random));
        }
        const int parent = choice(3) == 0 ? choice(l) : l - 1;
        const urdf_origin origin = choice(3) == 0 ? random_origin(random) : square();
        const triple axis = choice(3) == 0 ? draw_triple(1.0, random) : along();
        urdf.joint("j" + number, types[static_cast<std::size_t>(choice(static_cast<int>(types.size())))],
                   "l" + std::to_string(parent), "l" + number, origin, axis);
    }
    return urdf.text();
}

}  // namespace idim::test
