#pragma once

/// @file The units of what a study compares, as its tables and charts show them.

#include <string>

#include "study.hpp"

namespace mpmfast {

/// "J/m" for "J" where every scene of the study is a metre of a plane, nothing where some are.
std::string shown_unit(const StudyRuns& runs, const std::string& unit);

/// Does the rule look for one value: the last, or the place of a crossing?
bool looks_for_value(const ErrorSpec& spec);

/// Of what is compared, and of an error that is not relative; empty where nobody knows it.
std::string measured_unit(const StudyRuns& runs, const ErrorSpec& spec);

/// What stands on an axis that draws an expression: "kinetic (J/m)" for kinetic_J.
std::string axis_label(const StudyRuns& runs, const Expression& expression);

}  // namespace mpmfast
