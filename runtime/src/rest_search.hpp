#pragma once

#include <Eigen/Core>
#include <vector>

namespace idim {

/// Successive samples begin..end-1.
struct sample_run {
    Eigen::Index begin = 0;
    Eigen::Index end = 0;
};

/// Largest speed of a joint, and largest change of it from one sample to the next, of a series that comes in pieces.
class speed_extremes {
  public:
    void add(const Eigen::VectorXd& speed);
    double top_speed() const { return top_speed_; }
    double top_change() const { return top_change_; }

  private:
    double top_speed_ = 0.0;
    double top_change_ = 0.0;
    double last_ = 0.0;
    bool started_ = false;
};

/// Finds the rests of a joint in its decimated speed, piece by piece: runs of samples slower than `part` of the top
/// speed that last longer than a fifth of the time in which the top acceleration reaches the top speed, and than two
/// samples. A reversal at that acceleration passes through the slow range in 2 `part` of this time.
class rest_search {
  public:
    rest_search(const speed_extremes& extremes, double part);

    void add(const Eigen::VectorXd& speed);
    /// The rests; nothing may be added any more.
    std::vector<sample_run> finish();

  private:
    void end_run();

    double slow_;     ///< speed below which a joint may be at rest
    double longest_;  ///< run of slow samples that is no rest yet [samples]
    Eigen::Index place_ = 0;
    Eigen::Index begin_ = 0;  ///< of the slow run that ends here
    std::vector<sample_run> rests_;
};

/// Places of the samples first..first+count-1 that lie in none of the ascending runs, counted from `first`.
std::vector<Eigen::Index> rows_between(const std::vector<sample_run>& runs, Eigen::Index first, Eigen::Index count);

}  // namespace idim
