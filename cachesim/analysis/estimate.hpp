// Ratio estimates with 95 % confidence intervals.
//
// y_i, x_i: sums of sample index i, i = 1 … n. R = sum y / sum x. Ratio estimator (Cochran, Sampling Techniques, 1977,
// section 6.3), without finite population correction:
//     var R = sum (y_i - R x_i)^2 / (n (n - 1) mean(x)^2)
// A ratio Q = R / R' to a baseline that has the same sample indices, first-order expansion with paired residuals:
//     e_i = (y_i - R x_i) / mean(y) - (y'_i - R' x'_i) / mean(y'),   var Q = Q^2 sum e_i^2 / (n (n - 1))
// A product of powers of totals Q = prod_k (sum_i v_ki)^p_k, such as a factor of the traffic identity or a part of a
// predicted speed-up, by the delta method on log Q (Cochran 1977, section 6.3; Casella & Berger, Statistical Inference,
// 2002, section 5.5.4), which is the same expansion:
//     e_i = sum_k p_k v_ki / mean(v_k),   var Q = Q^2 sum (e_i - mean(e))^2 / (n (n - 1))
// half width = t(0.975, n - 1) sqrt(var). Every "±" of a report is such a half width.
#pragma once

#include <optional>
#include <vector>

namespace raycache::cachesim {

/// A ratio of totals over sample indices (bytes over rays, this strategy's bytes/ray over the baseline's). half_width
/// is that of its 95 % confidence interval: ratio estimator (Cochran 1977, section 6.3) over the indices, Student t;
/// absent for one index. Against a baseline the residuals are taken index by index (paired), so what all strategies
/// share cancels. The mean is NaN (text "-", JSON null, CSV empty) where the denominator is zero.
struct Estimate {
    double mean = 0;
    std::optional<double> half_width;
};

/// The same with the width of its interval multiplied.
inline Estimate widened(Estimate estimate, double times) {
    if (estimate.half_width) *estimate.half_width *= times;
    return estimate;
}

/// Sums per sample index, in the same order.
struct Sums {
    std::vector<double> y, x;
};

/// sum y / sum x.
Estimate ratio_of_totals(const Sums&);

/// (sum y / sum x) of one over that of the baseline, index by index.
Estimate ratio_to_baseline(const Sums&, const Sums& baseline);

/// One factor of a product: a total over sample indices, to a power.
struct Power {
    std::vector<double> values;  ///< of each sample index
    int exponent = 1;
};

/// The product of the totals to their powers; all of the same sample indices. No number where a total that is divided
/// by is 0; no interval where any total is.
Estimate product_of_powers(const std::vector<Power>&);

/// The 0.975 quantile of Student's t distribution; degrees of freedom >= 1.
double student_t_975(std::size_t degrees_of_freedom);

/// By how much wider than a 95 % interval one is that misses in a share `error` of all cases; degrees of freedom >= 1.
double widening(std::size_t degrees_of_freedom, double error);

}  // namespace raycache::cachesim
