#pragma once

#include <map>
#include <string>
#include <vector>

#include "undeclared/joint_scales.hpp"

namespace idim::undeclared {

/// Something a robot has and its description does not.
struct missing_effect {
    std::string form;  ///< what the plant does: one of the forms below
    std::string name;  ///< its name in the catalogue, or of the nearest; empty outside the catalogue
    int joint = 0;     ///< where it acts; of a load, the link that carries it
    int other = -1;    ///< of a pair: the other joint
    std::map<std::string, double> linear;  ///< proportional to the strength, named as in the catalogue
    std::map<std::string, double> shape;   ///< the rest

    double size(const std::string& parameter) const { return linear.at(parameter); }
    double at(const std::string& parameter) const { return shape.at(parameter); }
};

/// The same effect, `factor` times as strong.
missing_effect scaled(missing_effect effect, double factor);

/// Names in the catalogue whose form is exact.
const std::vector<std::string>& catalogue_forms();
/// Forms near a catalogue entry: another exponent, a tanh for an exponential, ripple that is no sinusoid.
const std::vector<std::string>& near_forms();
/// Forms that no entry of the catalogue is near to.
const std::vector<std::string>& outside_forms();
/// Forms within the span of the rigid model and its declared friction.
const std::vector<std::string>& span_forms();

/// Whether a robot of this kind can have such an effect at that joint at all.
bool possible(const std::string& form, const arm& robot, int joint);

/// An effect of random shape that is of the size of a tenth of the joint's torque, `duration` being that of a log [s].
missing_effect random_effect(const std::string& form, const arm& robot, int joint, const joint_scales& scales,
                             double duration, sampler& random);

}  // namespace idim::undeclared
