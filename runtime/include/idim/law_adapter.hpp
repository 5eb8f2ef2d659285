#pragma once

#include <iterator>

#include "idim/law_interface.h"

namespace idim {

/// The functions of law_interface.h for a `struct control_law` of a user.
template <class Law>
struct law_adapter {
    static void* create() { return new Law(); }
    static void* copy(const void* law) { return new Law(*static_cast<const Law*>(law)); }
    static void destroy(void* law) { delete static_cast<Law*>(law); }
    static void command(void* law, const idim_law_sample* sample, double* v) {
        static_cast<Law*>(law)->command(*sample, v);
    }
    static void limited(void* law, const double* wanted, const double* given) {
        tell(*static_cast<Law*>(law), wanted, given, 0);
    }

    static const idim_law_table* table() {
        static const idim_law_table the_law = {IDIM_LAW_ABI,
                                               static_cast<int>(std::size(Law::values)),
                                               std::data(Law::values),
                                               create,
                                               copy,
                                               destroy,
                                               command,
                                               limited};
        return &the_law;
    }

  private:
    template <class L>
    static auto tell(L& law, const double* wanted, const double* given, int) -> decltype(law.limited(wanted, given)) {
        law.limited(wanted, given);
    }
    template <class L>
    static void tell(L&, const double*, const double*, long) {}
};

}  // namespace idim
