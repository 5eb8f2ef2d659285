#include "idim/zero_phase_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace idim {
namespace {

// The recursion is a chain of dependent operations from sample to sample; running this many columns side by side fills
// the vector registers instead of waiting for it.
constexpr int lanes = 8;
using lane = Eigen::Array<double, lanes, 1>;
using lane_buffer = Eigen::Array<double, lanes, Eigen::Dynamic>;  // one sample of all lanes per column

/// State of the transposed direct form II of one section.
struct section_state {
    lane s1;
    lane s2;
};

/// Steady state of the cascade for a constant input `level`: y = G x, s2 = (b2 - a2 G) x, s1 = (b1 - a1 G) x + s2.
std::vector<section_state> steady_state(const second_order_sections& filter, const lane& level) {
    std::vector<section_state> state;
    lane input = level;
    for (const second_order_section& s : filter.sections) {
        const double dc_gain = (s.b0 + s.b1 + s.b2) / (1.0 + s.a1 + s.a2);
        const lane s2 = (s.b2 - s.a2 * dc_gain) * input;
        state.push_back({(s.b1 - s.a1 * dc_gain) * input + s2, s2});
        input *= dc_gain;
    }
    return state;
}

void advance(const second_order_sections& filter, std::vector<section_state>& state, lane& sample) {
    for (size_t k = 0; k < filter.sections.size(); ++k) {
        const second_order_section& s = filter.sections[k];
        const lane output = s.b0 * sample + state[k].s1;
        state[k].s1 = s.b1 * sample - s.a1 * output + state[k].s2;
        state[k].s2 = s.b2 * sample - s.a2 * output;
        sample = output;
    }
}

void filter_both_ways(const second_order_sections& filter, lane_buffer& buffer) {
    std::vector<section_state> state = steady_state(filter, buffer.col(0));
    const auto pass = [&](Eigen::Index k) {
        lane sample = buffer.col(k);
        advance(filter, state, sample);
        buffer.col(k) = sample;
    };
    for (Eigen::Index k = 0; k < buffer.cols(); ++k) {
        pass(k);
    }
    state = steady_state(filter, buffer.col(buffer.cols() - 1));
    for (Eigen::Index k = buffer.cols() - 1; k >= 0; --k) {
        pass(k);
    }
}

/// Writes signals columns[first..first+count-1] into the lanes, with odd reflection 2 x_end - x at both ends. Row by
/// row, since the columns of a row-major matrix lie side by side.
void extend(const signal_columns& signals, const Eigen::Index* columns, size_t count, Eigen::Index pad,
            lane_buffer& buffer) {
    const Eigen::Index last = signals.rows() - 1;
    for (Eigen::Index row = 0; row <= last; ++row) {
        for (size_t k = 0; k < count; ++k) {
            buffer(static_cast<Eigen::Index>(k), pad + row) = signals(row, columns[k]);
        }
    }
    for (Eigen::Index k = 1; k <= pad; ++k) {
        buffer.col(pad - k) = 2.0 * buffer.col(pad) - buffer.col(pad + k);
        buffer.col(pad + last + k) = 2.0 * buffer.col(pad + last) - buffer.col(pad + last - k);
    }
}

bool is_zero(const signal_columns& signals, Eigen::Index column) {
    for (Eigen::Index row = 0; row < signals.rows(); ++row) {
        if (signals(row, column) != 0.0) {
            return false;
        }
    }
    return true;
}

std::vector<Eigen::Index> nonzero_columns(const signal_columns& signals) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index column = 0; column < signals.cols(); ++column) {
        if (!is_zero(signals, column)) {
            columns.push_back(column);
        }
    }
    return columns;
}

}  // namespace

Eigen::Index padding(const second_order_sections& filter) {
    return Eigen::Index{3} * (filter.order + 1);
}

Eigen::Index settling(const second_order_sections& filter) {
    constexpr double forgotten = 1e-16;
    std::vector<section_state> state = steady_state(filter, lane::Constant(1.0));
    Eigen::Index samples = 0;
    Eigen::Index quiet = 0;
    // As long as the slowest oscillation may pass through zero, quiet has to last.
    while (quiet <= samples / 2) {
        lane sample = lane::Zero();
        advance(filter, state, sample);
        quiet = std::abs(sample[0]) < forgotten ? quiet + 1 : 0;
        ++samples;
    }
    return samples - quiet;
}

Eigen::MatrixXd zero_phase_filter(const second_order_sections& filter, const signal_columns& signals,
                                  Eigen::Index stride) {
    const Eigen::Index pad = padding(filter);
    if (signals.rows() <= pad) {
        throw std::invalid_argument("zero_phase_filter: " + std::to_string(signals.rows()) +
                                    " samples, the filter needs more than " + std::to_string(pad));
    }
    const Eigen::Index kept = (signals.rows() + stride - 1) / stride;
    Eigen::MatrixXd filtered = Eigen::MatrixXd::Zero(kept, signals.cols());
    const std::vector<Eigen::Index> columns = nonzero_columns(signals);
    lane_buffer buffer = lane_buffer::Zero(lanes, signals.rows() + 2 * pad);
    for (size_t first = 0; first < columns.size(); first += lanes) {
        const size_t count = std::min<size_t>(lanes, columns.size() - first);
        extend(signals, &columns[first], count, pad, buffer);
        filter_both_ways(filter, buffer);
        for (Eigen::Index row = 0; row < kept; ++row) {
            for (size_t k = 0; k < count; ++k) {
                filtered(row, columns[first + k]) = buffer(static_cast<Eigen::Index>(k), pad + row * stride);
            }
        }
    }
    return filtered;
}

second_order_sections decimation_filter(int decimation) {
    return chebyshev_lowpass(8, 0.05, 0.8 / decimation);
}

Eigen::MatrixXd decimate(const signal_columns& signals, int decimation) {
    if (decimation == 1) {
        return signals;
    }
    return zero_phase_filter(decimation_filter(decimation), signals, decimation);
}

}  // namespace idim
