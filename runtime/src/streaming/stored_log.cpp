#include "idim/stored_log.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>

#include "streaming/scratch_table.hpp"
#include "uniform_time.hpp"

namespace idim {

namespace {

constexpr Eigen::Index rows_at_once = Eigen::Index{1} << 14;
constexpr double jitter_tolerance = 1e-3;  // as resample_uniform

/// Signals that are kept, in the order of a row behind the time.
constexpr std::array kept_signals = {&log::q, &log::tau, &log::temp};

Eigen::MatrixXd table_of(const log& data) {
    Eigen::Index width = 1;
    for (const auto signal : kept_signals) {
        width += (data.*signal).cols();
    }
    Eigen::MatrixXd table(data.samples(), width);
    table.col(0) = data.t;
    Eigen::Index next = 1;
    for (const auto signal : kept_signals) {
        const Eigen::MatrixXd& values = data.*signal;
        if (values.cols() > 0) {
            table.middleCols(next, values.cols()) = values;
            next += values.cols();
        }
    }
    return table;
}

/// Calls `use` with the times of a table, block by block.
template <typename Use>
void for_times(const scratch_table& table, const Use& use) {
    for (Eigen::Index first = 0; first < table.rows(); first += rows_at_once) {
        const Eigen::Index count = std::min(rows_at_once, table.rows() - first);
        use(first, Eigen::VectorXd(table.read(first, count).col(0)));
    }
}

/// is_uniform (uniform_time.hpp) of the times of a table.
bool has_uniform_times(const scratch_table& table) {
    const double start = table.read(0, 1)(0, 0);
    const double period = (table.read(table.rows() - 1, 1)(0, 0) - start) / static_cast<double>(table.rows() - 1);
    double farthest = 0.0;
    for_times(table, [&](Eigen::Index first, const Eigen::VectorXd& t) {
        const auto place =
            Eigen::ArrayXd::LinSpaced(t.size(), static_cast<double>(first), static_cast<double>(first + t.size() - 1));
        farthest = std::max(farthest, (t.array() - (start + place * period)).abs().maxCoeff());
    });
    return farthest <= jitter_tolerance * period;
}

/// median_period (uniform_time.hpp) of the times of a table, in four passes: the bits of positive numbers ascend as the
/// numbers do, and every pass finds sixteen of them, the highest first.
double median_step(const scratch_table& table) {
    constexpr int digits = 16;
    std::uint64_t known = 0;
    auto rank = static_cast<std::uint64_t>((table.rows() - 1) / 2);
    for (int shift = 64 - digits; shift >= 0; shift -= digits) {
        std::vector<std::uint64_t> count(std::size_t{1} << digits, 0);
        double before = 0.0;
        for_times(table, [&](Eigen::Index first, const Eigen::VectorXd& t) {
            for (Eigen::Index k = 0; k < t.size(); ++k) {
                const auto bits = std::bit_cast<std::uint64_t>(t[k] - before);
                before = t[k];
                const bool is_candidate = shift + digits == 64 || bits >> (shift + digits) == known;
                if (first + k > 0 && is_candidate) {
                    ++count[(bits >> shift) & ((std::uint64_t{1} << digits) - 1)];
                }
            }
        });
        std::uint64_t digit = 0;
        for (; rank >= count[digit]; ++digit) {
            rank -= count[digit];
        }
        known = known << digits | digit;
    }
    return std::bit_cast<double>(known);
}

}  // namespace

struct stored_log::contents {
    std::string file;
    std::array<Eigen::Index, kept_signals.size()> width = {};  ///< columns of each kept signal
    std::optional<scratch_table> table;
    double rate = 0.0;
    Eigen::VectorXd lowest;
    Eigen::VectorXd highest;

    void take(const log& block);
    void resample();
    log rows(Eigen::Index first, Eigen::Index count) const;
};

void stored_log::contents::take(const log& block) {
    if (!table) {
        for (std::size_t s = 0; s < kept_signals.size(); ++s) {
            width[s] = (block.*kept_signals[s]).cols();
        }
        lowest = highest = block.q.row(0);
    }
    const Eigen::MatrixXd rows = table_of(block);
    if (!table) {
        table.emplace(rows.cols());
    }
    table->append(rows);
    lowest = lowest.cwiseMin(block.q.colwise().minCoeff().transpose());
    highest = highest.cwiseMax(block.q.colwise().maxCoeff().transpose());
}

log stored_log::contents::rows(Eigen::Index first, Eigen::Index count) const {
    const Eigen::MatrixXd values = table->read(first, count);
    log data;
    data.file = file;
    data.t = values.col(0);
    Eigen::Index next = 1;
    for (std::size_t s = 0; s < kept_signals.size(); ++s) {
        if (width[s] > 0) {
            data.*kept_signals[s] = values.middleCols(next, width[s]);
            next += width[s];
        }
    }
    return data;
}

/// The same samples as resample_uniform's.
void stored_log::contents::resample() {
    if (table->rows() < 3 || has_uniform_times(*table)) {
        return;
    }
    const double period = median_step(*table);
    const double start = table->read(0, 1)(0, 0);
    const Eigen::Index samples = grid_samples(table->read(table->rows() - 1, 1)(0, 0) - start, period);
    scratch_table uniform(table->width());
    Eigen::Index from = 0;  // recorded sample at or before the next grid time, with two more before it where there are
    for (Eigen::Index first = 0; first < samples; first += rows_at_once) {
        const Eigen::Index count = std::min(rows_at_once, samples - first);
        const Eigen::VectorXd grid = start + Eigen::ArrayXd::LinSpaced(count, static_cast<double>(first),
                                                                       static_cast<double>(first + count - 1)) *
                                                 period;
        Eigen::Index size = std::min(rows_at_once, table->rows() - from);
        while (from + size < table->rows() && table->read(from + size - 3, 1)(0, 0) <= grid[count - 1]) {
            size = std::min(2 * size, table->rows() - from);
        }
        const log recorded = rows(from, size);
        uniform.append(table_of(interpolated(recorded, grid)));
        const auto next = std::upper_bound(recorded.t.begin(), recorded.t.end(), grid[count - 1]);
        from = std::max(Eigen::Index{0}, from + static_cast<Eigen::Index>(next - recorded.t.begin()) - 3);
    }
    table = std::move(uniform);
}

stored_log::stored_log(const std::string& file, const log_columns& columns,
                       const std::function<void(const log&)>& check)
    : held_(std::make_unique<contents>()) {
    held_->file = file;
    log_reader reader(file, columns);
    for (log block = reader.next(rows_at_once); block.samples() > 0; block = reader.next(rows_at_once)) {
        if (check) {
            check(block);
        }
        held_->take(block);
    }
    held_->resample();
    const double end = held_->table->read(samples() - 1, 1)(0, 0);
    held_->rate = uniform_rate(samples(), end - start(), {file, 0, "t"});
}

stored_log::stored_log(stored_log&&) noexcept = default;
stored_log& stored_log::operator=(stored_log&&) noexcept = default;
stored_log::~stored_log() = default;

const std::string& stored_log::file() const {
    return held_->file;
}

Eigen::Index stored_log::samples() const {
    return held_->table->rows();
}

double stored_log::rate() const {
    return held_->rate;
}

double stored_log::start() const {
    return held_->table->read(0, 1)(0, 0);
}

Eigen::VectorXd stored_log::range() const {
    return held_->highest - held_->lowest;
}

log stored_log::part(Eigen::Index first, Eigen::Index count) const {
    return held_->rows(first, count);
}

}  // namespace idim
