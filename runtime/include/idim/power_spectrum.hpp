#pragma once

#include <Eigen/Core>

namespace idim {

/// One-sided power spectral density of one signal.
struct power_spectrum {
    Eigen::ArrayXd frequency;  ///< [Hz], 0, rate/L, ..., about rate/2
    Eigen::ArrayXd density;    ///< [unit^2/Hz]; its integral over the frequency is the variance
};

/// The average of welch_spectrum over segments that are given one by one.
class welch_average {
  public:
    welch_average(double rate, Eigen::Index segment);

    /// Takes in one segment. Successive ones begin `step` samples apart.
    void add(const Eigen::Ref<const Eigen::VectorXd>& segment);
    Eigen::Index step() const { return window_.size() - window_.size() / 2; }
    power_spectrum spectrum() const;

  private:
    double rate_;
    Eigen::VectorXd window_;
    Eigen::ArrayXd power_;
    int segments_ = 0;
};

/// Welch's average of modified periodograms: Hann window, segments of `segment` samples that overlap by half, the mean
/// of each removed (P. D. Welch, IEEE Trans. Audio Electroacoustics 15(2), 1967). Same as scipy.signal.welch(x, rate,
/// 'hann', nperseg=segment). Throws std::invalid_argument unless 2 <= segment <= samples.
power_spectrum welch_spectrum(const Eigen::Ref<const Eigen::VectorXd>& x, double rate, Eigen::Index segment);

/// Largest 2^a or 3 * 2^a not above a quarter of `samples`: at least seven segments, and a length the FFT likes.
Eigen::Index welch_segment(Eigen::Index samples);

/// Smallest frequency below which the share `share` of the energy up to `limit` [Hz] lies.
double energy_frequency(const power_spectrum& spectrum, double share, double limit);

}  // namespace idim
