#pragma once

/// @file Ellipses in the plane: area, extent, overlap, gap. Uses + − × ÷ √ alone, which round the same
/// everywhere.

namespace mpmfast {

inline constexpr double kPi = 3.14159265358979323846;

struct Ellipse {
  double x = 0, y = 0;          ///< centre
  double major = 1, minor = 1;  ///< semi-axes
  double cosine = 1, sine = 0;  ///< direction of the major axis

  double area() const { return kPi * major * minor; }
  double half_width() const;  ///< of the box along x and y around it
  double half_height() const;
  bool contains(double px, double py) const;
  Ellipse grown(double by) const { return {x, y, major + by, minor + by, cosine, sine}; }
};

/// Do two ellipses have no point in common?
bool disjoint(const Ellipse& a, const Ellipse& b);

/// The distance between two disjoint ellipses, to about 0.1 % of their size; never too small by more than
/// rounding.
double gap(const Ellipse& a, const Ellipse& b);

}  // namespace mpmfast
