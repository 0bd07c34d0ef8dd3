#pragma once

#include "posewright/criterion/criterion_data.hpp"
#include "posewright/criterion/information_function.hpp"

namespace posewright {

/// Functions of the singular values σ1 ≥ … ≥ σs of the scaled G with nuisance eliminated (theory.md eq. (18)):
///   o2 = σs/σ1 (Driels & Pathre 1990), o3 = σs (Nahvi et al. 1994), o4 = σs²/σ1 (Nahvi & Hollerbach 1996),
///   o5 = 1/Σ σi⁻¹ (Sun & Hollerbach 2008).
/// The search maximises the logarithm. They depend on the scale of the columns. ln o3 and ln o5 are concave in M and
/// bounded (squared, both are matrix means of degree 1: Pukelsheim 2006, Optimal Design of Experiments, 6.7); o2 and o4
/// are not.
enum class SpectralIndex { o2, o3, o4, o5 };
std::unique_ptr<Criterion> make_spectral_criterion(SpectralIndex index, const CriterionData& data);

}  // namespace posewright
