#pragma once

#include <memory>
#include <string>

#include "idim/filtered_samples.hpp"
#include "idim/stored_log.hpp"

namespace idim {

/// The filtered samples of one log, to be read in parts.
class motion_source {
  public:
    virtual ~motion_source() = default;

    virtual const std::string& file() const = 0;
    virtual double rate() const = 0;  ///< [Hz]
    virtual Eigen::Index samples() const = 0;
    /// Samples first..first+count-1.
    virtual filtered_samples part(Eigen::Index first, Eigen::Index count) const = 0;
};

/// Samples in memory, which must outlive it.
class resident_motion : public motion_source {
  public:
    explicit resident_motion(const filtered_samples& all) : all_(all) {}

    const std::string& file() const override { return all_.file; }
    double rate() const override { return all_.rate; }
    Eigen::Index samples() const override { return all_.samples(); }
    filtered_samples part(Eigen::Index first, Eigen::Index count) const override;

  private:
    const filtered_samples& all_;
};

/// What filter_log gives of a stored log, which must outlive it. Throws input_error as filter_log.
std::unique_ptr<motion_source> filter_log(const stored_log& data, const filter_choice& choice);

}  // namespace idim
