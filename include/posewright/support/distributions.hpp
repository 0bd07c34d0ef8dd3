#pragma once

namespace posewright {

/// Probability functions, by Boost.Math behind one source: its templates take a compiler seconds wherever they are met.
/// All throw std::domain_error if degrees of freedom are not positive or a probability is outside (0, 1).

/// Chance that a χ² of `freedom` degrees is larger than `value`.
double chi_square_exceeded(double value, double freedom);
/// Quantile of χ² with `freedom` degrees at this probability.
double chi_square_quantile(double probability, double freedom);
/// Value that it exceeds with the probability `tail`.
double chi_square_upper_quantile(double tail, double freedom);
/// Noncentral variant of chi_square_exceeded: noncentrality λ.
double noncentral_chi_square_exceeded(double value, double freedom, double noncentrality);
/// Chance that Fisher's F of these degrees of freedom is larger than `value`.
double fisher_exceeded(double value, double numerator_freedom, double denominator_freedom);
/// Chance that a standard normal number is larger than `value`.
double normal_exceeded(double value);
/// Value that a standard normal number exceeds with the probability `tail`.
double normal_upper_quantile(double tail);
/// Value that Student's t of `freedom` degrees exceeds with the probability `tail`.
double student_upper_quantile(double tail, double freedom);
/// Chance that Student's t of `freedom` degrees is larger than `value`.
double student_exceeded(double value, double freedom);
/// Chance that of `draws` more than `value` are hits, each with this probability; 1 if `value` < 0.
double binomial_exceeded(int value, int draws, double probability);

}  // namespace posewright
