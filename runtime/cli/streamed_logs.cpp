#include "streamed_logs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "idim/streamed_identification.hpp"

namespace idim::cli {

bool are_large(const std::vector<std::string>& files) {
    constexpr double mebibyte = 1024.0 * 1024.0;
    constexpr double compression = 4.0;  // of numbers as text
    double size = 0.0;
    for (const std::string& file : files) {
        std::error_code error;
        const auto bytes = std::filesystem::file_size(file, error);
        const bool is_compressed = std::filesystem::path(file).extension() == ".gz";
        size += error ? 0.0 : (is_compressed ? compression : 1.0) * static_cast<double>(bytes);
    }
    return size > 256.0 * mebibyte;
}

std::string streaming_obstacle(const loaded_robot& robot, const std::string& method, bool averages) {
    const bool is_least_squares = method == "ols" || method == "wls";
    if (!is_least_squares && !(averages && method == "cwls")) {
        return fmt::format("not with --method {}, expected ols or wls, or cwls with --period", method);
    }
    const std::string need = averages ? "" : whole_log_need(robot.model());
    return need.empty() ? ""
                        : fmt::format("the model of {} has {}, which need the log as a whole, expected a model without",
                                      robot.generated.robot, need);
}

streamed_outcome identify_streamed(const loaded_robot& robot, const std::vector<stored_log>& logs,
                                   const filter_choice& filter, const std::string& method) {
    const auto least_squares = method == "ols" ? least_squares_method::ols : least_squares_method::wls;
    streamed_identification result = idim::identify_streamed(robot.model(), logs, filter, least_squares);
    observation no_rows;
    no_rows.dof = robot.model().dof;
    no_rows.n_base = robot.model().n_base;
    for (std::size_t i = 0; i < logs.size(); ++i) {
        observation_block block;
        block.file = logs[i].file();
        block.rate = result.row_rates[i];
        no_rows.blocks.push_back(std::move(block));
    }
    method_result by;
    by.method = method;
    by.fit = result.fit;
    by.residual = std::move(result.residual);
    return {{robot, filter, std::move(no_rows), std::move(result.fit), std::move(result.essential)}, std::move(by)};
}

}  // namespace idim::cli
