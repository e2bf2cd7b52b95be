#pragma once

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

/// The best of an upright box, an upright cylinder and a sphere (Mar09a, P31), by the evidence all methods are judged by; needs no class.
///
/// Box: the smallest rectangle around the points' footprint, from the support to their 99.5 % quantile of height. Cylinder: the circle
/// that the points with level normals lie on (Kasa's fit), the same height. Sphere: the least-squares sphere (its lowest point may be
/// below the support: it is then lifted onto it). @return as fit_superquadric, with the method `simple_primitive`.
FittedModel fit_simple_primitive(const ObjectView& view);

}  // namespace gfp
