#include "description/inertial_parameters.hpp"

#include <stdexcept>

#include "description/rigid_pose.hpp"

namespace idim::generator {

namespace {

/// A rigid body seen from some frame: mass, first moments and inertia about the frame's origin.
struct body {
    decimal mass;
    decimal_vector moments;
    decimal_matrix inertia;
};

decimal_vector vector_of(const double* values) {
    return {decimal_of(values[0]), decimal_of(values[1]), decimal_of(values[2])};
}

/// From xx xy xz yy yz zz.
decimal_matrix symmetric_of(const double* m) {
    decimal_matrix matrix;
    matrix << decimal_of(m[0]), decimal_of(m[1]), decimal_of(m[2]),  //
        decimal_of(m[1]), decimal_of(m[3]), decimal_of(m[4]),        //
        decimal_of(m[2]), decimal_of(m[4]), decimal_of(m[5]);
    return matrix;
}

rigid_pose pose_of_link(const link_placement& placement) {
    rigid_pose pose;
    for (int i = 0; i < 3; ++i) {
        pose.R.row(i) = vector_of(placement.rotation[static_cast<std::size_t>(i)].data()).transpose();
    }
    pose.p = vector_of(placement.position.data());
    return pose;
}

/// Huygens and Steiner: what a mass at `centre` adds to the inertia about the origin.
decimal_matrix steiner(const decimal& mass, const decimal_vector& centre) {
    return mass * (centre.dot(centre) * decimal_matrix::Identity() - centre * centre.transpose());
}

/// The same body from another frame; `pose` is that of the old frame in the new one.
body seen_from(const body& b, const rigid_pose& pose) {
    const decimal_vector turned = pose.R * b.moments;
    const decimal_vector& p = pose.p;
    // The inertia of a shifted body: sum m |x + p|^2 expanded, which needs no division by the mass.
    const decimal_matrix mixed = turned * p.transpose() + p * turned.transpose();
    const decimal_matrix shift = 2 * p.dot(turned) * decimal_matrix::Identity() - mixed + steiner(b.mass, p);
    return {b.mass, turned + b.mass * p, pose.R * b.inertia * pose.R.transpose() + shift};
}

std::array<double, 6> upper_triangle(const decimal_matrix& m) {
    return {nearest_double(m(0, 0)), nearest_double(m(0, 1)), nearest_double(m(0, 2)),
            nearest_double(m(1, 1)), nearest_double(m(1, 2)), nearest_double(m(2, 2))};
}

}  // namespace

inertial_parameters parameters_of(const urdf_inertial& inertial, const link_placement& placement) {
    const body central = {decimal_of(inertial.mass), decimal_vector::Zero(), symmetric_of(inertial.inertia.data())};
    const body in_ours = seen_from(central, pose_of_link(placement) * pose_of(inertial.xyz, inertial.rpy));
    const std::array<double, 6> I = upper_triangle(in_ours.inertia);
    return {I[0],
            I[1],
            I[2],
            I[3],
            I[4],
            I[5],
            nearest_double(in_ours.moments[0]),
            nearest_double(in_ours.moments[1]),
            nearest_double(in_ours.moments[2]),
            nearest_double(in_ours.mass)};
}

urdf_inertial inertial_of(const inertial_parameters& parameters, const link_placement& placement) {
    const body in_ours = {decimal_of(parameters[9]), vector_of(&parameters[6]), symmetric_of(parameters.data())};
    if (in_ours.mass == 0 && in_ours.moments != decimal_vector::Zero()) {
        throw std::invalid_argument("first moments without a mass, expected a mass other than zero");
    }
    const body in_link = seen_from(in_ours, pose_of_link(placement).inverse());
    urdf_inertial inertial;
    inertial.mass = parameters[9];
    inertial.rpy = placement.rpy;
    decimal_matrix central = in_link.inertia;
    if (in_link.mass != 0) {
        const decimal_vector centre = in_link.moments / in_link.mass;
        central -= steiner(in_link.mass, centre);
        inertial.xyz = {nearest_double(centre[0]), nearest_double(centre[1]), nearest_double(centre[2])};
    }
    const decimal_matrix R = pose_of({0.0, 0.0, 0.0}, inertial.rpy).R;
    inertial.inertia = upper_triangle(R.transpose() * central * R);
    return inertial;
}

}  // namespace idim::generator
