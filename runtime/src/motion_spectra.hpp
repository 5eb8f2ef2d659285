#pragma once

#include <functional>
#include <string>
#include <vector>

#include "idim/log.hpp"
#include "idim/power_spectrum.hpp"

namespace idim {

/// A uniform log that can be read in parts.
struct readable_log {
    std::string file;
    Eigen::Index samples = 0;
    double rate = 0.0;
    std::function<log(Eigen::Index first, Eigen::Index count)> part;
};

/// A log in memory, made uniform.
readable_log readable_in_memory(const log& data);

/// Spectra of one joint in one log.
struct joint_spectra {
    power_spectrum acceleration;
    power_spectrum torque;  ///< empty without torque
    double lowest = 0.0;    ///< [Hz] below it the position has its energy, or the spectrum no resolution
};

/// Appends the spectra of the joints that move. Throws input_error if the log is shorter than 64 samples.
void append_spectra(const readable_log& data, std::vector<joint_spectra>& spectra);

}  // namespace idim
