#include <Eigen/Geometry>

#include "idim/motion_limits.hpp"

namespace idim {

namespace {

Eigen::Isometry3d frame_in_parent(const link_row& row, const Eigen::VectorXd& q) {
    const double moved = row.rate.dot(q);
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.rotate(Eigen::AngleAxisd(row.gamma, Eigen::Vector3d::UnitZ()));
    frame.translate(Eigen::Vector3d(0.0, 0.0, row.b));
    frame.rotate(Eigen::AngleAxisd(row.alpha, Eigen::Vector3d::UnitX()));
    frame.translate(Eigen::Vector3d(row.d, 0.0, 0.0));
    frame.rotate(Eigen::AngleAxisd(row.theta + (row.prismatic ? 0.0 : moved), Eigen::Vector3d::UnitZ()));
    frame.translate(Eigen::Vector3d(0.0, 0.0, row.r + (row.prismatic ? moved : 0.0)));
    return frame;
}

}  // namespace

Eigen::Vector3d point_of_link(const std::vector<link_row>& links, int link, const Eigen::Vector3d& point,
                              const Eigen::VectorXd& q, Eigen::Matrix3Xd* jacobian) {
    std::vector<Eigen::Isometry3d> frames;
    for (const link_row& row : links) {
        const Eigen::Isometry3d own = frame_in_parent(row, q);
        frames.push_back(row.parent < 0 ? own : frames[static_cast<std::size_t>(row.parent)] * own);
    }
    const Eigen::Vector3d place = frames[static_cast<std::size_t>(link)] * point;
    if (jacobian != nullptr) {
        jacobian->setZero(3, q.size());
        for (int i = link; i >= 0; i = links[static_cast<std::size_t>(i)].parent) {
            const link_row& row = links[static_cast<std::size_t>(i)];
            const Eigen::Isometry3d& frame = frames[static_cast<std::size_t>(i)];
            const Eigen::Vector3d axis = frame.linear().col(2);
            const Eigen::Vector3d moves = row.prismatic ? axis : axis.cross(place - frame.translation());
            *jacobian += moves * row.rate.transpose();
        }
    }
    return place;
}

}  // namespace idim
