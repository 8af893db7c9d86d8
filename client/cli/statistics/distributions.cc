// SPDX-License-Identifier: Apache-2.0
// The only file that includes Boost.Math, which takes long to compile.
#include "client/cli/statistics/distributions.h"

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace flatlight {
namespace {

namespace policies = boost::math::policies;
// Out of range is NaN or infinity, not an exception; double is enough.
using Quiet =
    policies::policy<policies::domain_error<policies::ignore_error>, policies::pole_error<policies::ignore_error>,
                     policies::overflow_error<policies::ignore_error>,
                     policies::evaluation_error<policies::ignore_error>, policies::promote_double<false>>;
using Student = boost::math::students_t_distribution<double, Quiet>;
using Fisher = boost::math::fisher_f_distribution<double, Quiet>;

}  // namespace

double StudentTail(double t, double degrees) { return 2 * cdf(complement(Student(degrees), t)); }

double StudentQuantile(double probability, double degrees) {
  return quantile(complement(Student(degrees), probability / 2));
}

double FisherTail(double f, double numerator_degrees, double denominator_degrees) {
  return cdf(complement(Fisher(numerator_degrees, denominator_degrees), f));
}

}  // namespace flatlight
