#include "torque_bands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "idim/autocorrelation.hpp"

namespace idim::cli {

namespace {

/// Errors of a joint's rows at their places among the samples of each log.
std::vector<gapped_series> errors_on_grid(const observation& rows, std::size_t joint, const Eigen::VectorXd& chi) {
    std::vector<gapped_series> errors;
    for (const observation_block& block : rows.blocks) {
        gapped_series series{Eigen::VectorXd::Zero(block.t.size()), Eigen::VectorXd::Zero(block.t.size())};
        series.value(block.kept[joint]) = block.Y[joint] - block.W[joint] * chi;
        series.present(block.kept[joint]).setOnes();
        errors.push_back(series);
    }
    return errors;
}

double independent_rows(const observation& rows, std::size_t joint, const Eigen::VectorXd& chi) {
    const std::vector<gapped_series> errors = errors_on_grid(rows, joint, chi);
    const Eigen::Index samples = samples_of(errors);
    if (samples == 0) {
        return 0.0;
    }
    const autoregression model = fit_autoregression(autocovariance(errors, highest_order(errors)), samples);
    return static_cast<double>(samples) / model.correlation_length(samples);
}

/// Half the width of the interval in which the covered share lies with 95 %, of so many independent rows.
double margin_of(double independent) {
    return band_quantile * std::sqrt(band_level * (1.0 - band_level) / std::max(independent, 1.0));
}

}  // namespace

torque_bands bands_of(const observation& rows, const Eigen::VectorXd& chi, const prediction_spread& spread) {
    torque_bands bands;
    for (std::size_t j = 0; j < spread.noise.size(); ++j) {
        joint_band band;
        bands.deviation.emplace_back();
        double inside = 0.0;
        for (const observation_block& block : rows.blocks) {
            const Eigen::MatrixXd& W = block.W[j];
            const Eigen::ArrayXd variance = (W * spread.covariance).cwiseProduct(W).rowwise().sum().cwiseMax(0.0);
            const Eigen::ArrayXd deviation = (variance + spread.noise[j] * spread.noise[j]).sqrt();
            const Eigen::ArrayXd error = (block.Y[j] - W * chi).cwiseAbs();
            band.from_parameters += variance.sum();
            band.half_width += band_quantile * deviation.sum();
            inside += static_cast<double>((error <= band_quantile * deviation).count());
            bands.deviation.back().emplace_back(deviation);
        }
        const double count = std::max(static_cast<double>(rows.rows(static_cast<int>(j))), 1.0);
        band.from_parameters = std::sqrt(band.from_parameters / count);
        band.half_width /= count;
        band.covered = inside / count;
        band.independent = independent_rows(rows, j, chi);
        bands.joints.push_back(band);
    }
    return bands;
}

void add_bands(json& joints, const torque_bands& bands, const prediction_spread& spread) {
    for (std::size_t j = 0; j < bands.joints.size(); ++j) {
        const joint_band& band = bands.joints[j];
        joints[j]["band"] = {{"level", band_level},
                             {"covered", band.covered},
                             {"covered_margin", margin_of(band.independent)},
                             {"half_width", band.half_width},
                             {"deviation_of_noise", spread.noise[j]},
                             {"deviation_of_parameters", band.from_parameters},
                             {"independent_rows", band.independent}};
    }
}

void print(const torque_bands& bands, const loaded_robot& robot) {
    for (std::size_t j = 0; j < bands.joints.size(); ++j) {
        const joint_band& band = bands.joints[j];
        const auto& joint = robot.generated.joints[j];
        const double margin = margin_of(band.independent);
        const char* verdict = std::abs(band.covered - band_level) <= margin ? "as it should be"
                              : band.covered < band_level ? "errors are larger here than where it was identified"
                                                          : "errors are smaller here than where it was identified";
        fmt::print(
            "    {}: the 95 % band of +-{:.3g} {} (parameters alone +-{:.2g}) holds {:.1f} % of the rows, 95 +- "
            "{:.1f} expected of {:.0f} independent ones: {}\n",
            joint.name, band.half_width, joint.prismatic ? "N" : "N*m", band_quantile * band.from_parameters,
            100.0 * band.covered, 100.0 * margin, band.independent, verdict);
    }
}

std::string series_text(const observation& rows, const Eigen::VectorXd& chi, const loaded_robot& robot,
                        const std::optional<torque_bands>& bands) {
    std::string text = "log,joint,t,tau,predicted,low,high\n";
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        const observation_block& block = rows.blocks[i];
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            const Eigen::VectorXd predicted = block.W[j] * chi;
            for (Eigen::Index k = 0; k < predicted.size(); ++k) {
                fmt::format_to(std::back_inserter(text), "{},{},{},{},{}", i + 1, robot.generated.joints[j].name,
                               block.t[block.kept[j][static_cast<std::size_t>(k)]], block.Y[j][k], predicted[k]);
                if (bands) {
                    const double half = band_quantile * bands->deviation[j][i][k];
                    fmt::format_to(std::back_inserter(text), ",{},{}\n", predicted[k] - half, predicted[k] + half);
                } else {
                    text += ",,\n";
                }
            }
        }
    }
    return text;
}

}  // namespace idim::cli
