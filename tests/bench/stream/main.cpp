// Logs larger than memory: the six-joint Denso along its multisine at 1 kHz, 450 000 and 4.5 million samples of six
// joints, identified in parts; each run in a process of its own, whose peak memory is given. Every sample a row,
// without deviations, and decimated by ten with them. Beside it the QR factorisation of LAPACK on the same rows.
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "idim/private_folder.hpp"
#include "log_file.hpp"
#include "streaming/streamed_rows.hpp"
#include "weighted_fit.hpp"

extern "C" const idim_model_interface* idim_model_denso_vp6242g(void);
extern "C" void dgeqrf_(const int* m, const int* n, double* A, const int* lda, double* tau, double* work,
                        const int* lwork, int* info);

namespace idim::bench {

namespace {

constexpr double rate = 1000.0;  // [Hz]

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Peak memory of this process [MB].
double peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

/// Sums of sinusoids that repeat every 380 s, within the ranges and speeds of the published excitation.
class multisine_motion {
  public:
    multisine_motion() {
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
        for (auto& joint : phase_) {
            for (double& value : joint) {
                value = phase(random);
            }
        }
    }

    /// Position, speed and acceleration of a joint.
    Eigen::Vector3d at(double t, int joint) const {
        constexpr double half_range[] = {2.35, 1.17, 0.43, 2.7, 1.57, 2.79};
        constexpr double centre[] = {0.0, 0.39, -1.13, 0.0, 0.0, 0.0};
        Eigen::Vector3d m(centre[joint], 0.0, 0.0);
        for (int k = 0; k < count; ++k) {
            const double w = 2.0 * std::numbers::pi * (5.0 + 6.0 * k + joint) / 380.0;
            const double amplitude = half_range[joint] / count;
            const double angle = w * t + phase_[joint][k];
            m += amplitude * Eigen::Vector3d(std::sin(angle), w * std::cos(angle), -w * w * std::sin(angle));
        }
        return m;
    }

  private:
    static constexpr int count = 12;
    double phase_[6][count] = {};
};

/// Writes a log of so many samples, nine digits a number, block by block.
void write_synthetic(const std::string& file, Eigen::Index samples) {
    constexpr Eigen::Index at_once = 4096;
    const idim_model_interface& model = *idim_model_denso_vp6242g();
    const multisine_motion motion;
    const Eigen::VectorXd chi = Eigen::VectorXd::LinSpaced(model.n_base, 0.5, 1.5);
    std::mt19937_64 random(2);
    std::normal_distribution<double> noise;
    log_file_writer writer(file);
    std::string text = "t,q1,q2,q3,q4,q5,q6,tau1,tau2,tau3,tau4,tau5,tau6\n";
    const auto append = [&](double value) {
        char number[32];
        text += ',';
        text.append(number, std::to_chars(number, number + sizeof number, value, std::chars_format::general, 9).ptr);
    };
    Eigen::MatrixXd q(at_once, 6);
    Eigen::MatrixXd qd = q;
    Eigen::MatrixXd qdd = q;
    Eigen::MatrixXd tau = q;
    const Eigen::VectorXd temp = Eigen::VectorXd::Zero(at_once * 6);
    for (Eigen::Index first = 0; first < samples; first += at_once) {
        const Eigen::Index size = std::min(at_once, samples - first);
        for (int joint = 0; joint < 6; ++joint) {
            for (Eigen::Index k = 0; k < size; ++k) {
                const Eigen::Vector3d m = motion.at(static_cast<double>(first + k) / rate, joint);
                q(k, joint) = m[0];
                qd(k, joint) = m[1];
                qdd(k, joint) = m[2];
            }
        }
        const idim_samples block = {
            static_cast<size_t>(size), at_once, q.data(), qd.data(), qdd.data(), nullptr, nullptr};
        model.inverse_dynamics_batch(&block, chi.data(), tau.data(), at_once);
        for (Eigen::Index k = 0; k < size; ++k) {
            char number[32];
            text.append(number,
                        std::to_chars(number, number + sizeof number, static_cast<double>(first + k) / rate).ptr);
            for (int joint = 0; joint < 6; ++joint) {
                append(q(k, joint) + 1e-6 * noise(random));
            }
            for (int joint = 0; joint < 6; ++joint) {
                append(tau(k, joint) + 0.1 * noise(random));
            }
            text += '\n';
        }
        writer.write(text);
        text.clear();
    }
    writer.commit();
}

void print_step(const char* what, double seconds, Eigen::Index rows) {
    fmt::print("  {:<58} {:>8.1f} s {:>9.1f} thousand rows/s {:>6.0f} MB\n", what, seconds,
               1e-3 * static_cast<double>(rows) / seconds, peak_memory());
    std::fflush(stdout);
}

/// The steps of an identification by weighted least squares, timed; deviations of decimated rows only.
void identify(const std::string& file, int decimation) {
    const idim_model_interface& model = *idim_model_denso_vp6242g();
    filter_choice choice;
    choice.cutoff = 10.0;
    choice.decimation = decimation;
    choice.minimum_speed = 0.01;
    log_columns columns;
    columns.joint_names.assign(model.joint_names, model.joint_names + model.dof);
    Eigen::Index samples = 0;
    const double reading = seconds_of([&] {
        log_reader reader(file, columns);
        for (log block = reader.next(1 << 14); block.samples() > 0; block = reader.next(1 << 14)) {
            samples += block.samples();
        }
    });
    std::vector<stored_log> logs;
    const double storing = seconds_of([&] { logs.emplace_back(file, columns); });
    std::unique_ptr<streamed_rows> rows;
    const double selecting = seconds_of([&] { rows = std::make_unique<streamed_rows>(model, logs, choice); });
    joint_triangles joints(model.dof, model.n_base);
    const double factoring = seconds_of([&] { joints = triangles_of(*rows); });
    fmt::print("{} samples, decimation {}: {} rows of {} columns, {:.0f} MB of text\n", samples, decimation,
               joints.rows(), model.n_base, 1e-6 * static_cast<double>(std::filesystem::file_size(file)));
    print_step("reading the log alone", reading, joints.rows());
    print_step("reading and storing it", storing, joints.rows());
    print_step("filtering, looking for rests (two passes)", selecting, joints.rows());
    print_step("filtering, evaluating, factoring", factoring, joints.rows());
    const double all = storing + selecting + factoring;
    print_step("estimate and errors, from the file", all, joints.rows());
    const Eigen::VectorXd chi = Eigen::VectorXd::LinSpaced(model.n_base, 0.5, 1.5);
    if (decimation == 1) {
        const std::vector<double> unweighted(static_cast<std::size_t>(model.dof), 1.0);
        const estimate ordinary = solve_weighted(joints, unweighted).fit;
        const estimate weighted = solve_weighted(joints, weights_of(ordinary.joint_deviation)).fit;
        fmt::print("  reading is {:.0f} % of it; largest error of a parameter {:.2g}\n", 100.0 * reading / all,
                   (weighted.chi - chi).cwiseAbs().maxCoeff());
        return;
    }
    estimate fit;
    const double solving = seconds_of([&] { fit = least_squares(*rows, joints, least_squares_method::wls); });
    print_step("deviations (six passes)", solving, joints.rows());
    print_step("estimate, errors and deviations, from the file", all + solving, joints.rows());
    fmt::print("  reading is {:.0f} % of it; largest error of a parameter {:.2g}, {:.1f} deviations\n",
               100.0 * reading / (all + solving), (fit.chi - chi).cwiseAbs().maxCoeff(),
               ((fit.chi - chi).array() / fit.deviations().array()).abs().maxCoeff());
}

/// Our factor of rows that are in memory, and LAPACK's, on the same blocks.
void compare_factors(const std::string& file) {
    const idim_model_interface& model = *idim_model_denso_vp6242g();
    log_columns columns;
    columns.joint_names.assign(model.joint_names, model.joint_names + model.dof);
    const std::vector<stored_log> logs = [&] {
        std::vector<stored_log> one;
        one.emplace_back(file, columns);
        return one;
    }();
    filter_choice choice;
    choice.cutoff = 10.0;
    const observation_block block = decimated_log(logs.front(), choice).part(model, 0, 8192);
    constexpr int repeats = 10;
    joint_triangles joints(model.dof, model.n_base);
    const double ours = seconds_of([&] {
        for (int k = 0; k < repeats; ++k) {
            for (std::size_t j = 0; j < block.W.size(); ++j) {
                joints.add(j, block.W[j], block.Y[j]);
            }
        }
    });
    const int n = model.n_base + 1;
    double theirs = 0.0;
    for (int k = 0; k < repeats; ++k) {
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            Eigen::MatrixXd A(block.W[j].rows(), n);
            A << block.W[j], block.Y[j];
            const int m = static_cast<int>(A.rows());
            const int size = 64 * n;
            std::vector<double> tau(static_cast<std::size_t>(n));
            std::vector<double> work(static_cast<std::size_t>(size));
            int info = 0;
            theirs += seconds_of([&] { dgeqrf_(&m, &n, A.data(), &m, tau.data(), work.data(), &size, &info); });
        }
    }
    const double rows = static_cast<double>(repeats) * 6.0 * 8192.0;
    fmt::print(
        "factor of rows in memory, {} columns with the torque, one core: ours {:.2f} million rows/s, LAPACK's dgeqrf "
        "{:.2f}, "
        "ratio {:.2f}\n",
        n, 1e-6 * rows / ours, 1e-6 * rows / theirs, theirs / ours);
}

/// Runs `work` in a process of its own, so that its peak memory is its alone.
bool in_own_process(const std::function<void()>& work) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        work();
        std::fflush(stdout);
        _exit(0);
    }
    int status = 0;
    return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

}  // namespace

int run() {
    const private_folder folder(std::filesystem::temp_directory_path() / "idim-stream-");
    bool well = true;
    for (const Eigen::Index samples : {450'000, 4'500'000}) {
        const std::string file = (folder.path() / "log.csv").string();
        well = in_own_process([&] { write_synthetic(file, samples); }) && well;
        well = in_own_process([&] { identify(file, 1); }) && well;
        well = in_own_process([&] { identify(file, 10); }) && well;
        if (samples == 450'000) {
            well = in_own_process([&] { compare_factors(file); }) && well;
        }
    }
    return well ? 0 : 1;
}

}  // namespace idim::bench

int main() {
    mallopt(M_MMAP_THRESHOLD, 1 << 25);  // as the command does
    mallopt(M_TRIM_THRESHOLD, 1 << 26);
    return idim::bench::run();
}
