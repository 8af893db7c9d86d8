// SPDX-License-Identifier: Apache-2.0
// Random changes to JSON texts that leave most of their structure alone, so that they get past the parser.
#ifndef FLATLIGHT_TESTS_FUZZ_MUTATION_H_
#define FLATLIGHT_TESTS_FUZZ_MUTATION_H_

#include <random>
#include <string>

namespace flatlight {

// One change: a bit of a byte; a number replaced by an extreme one; a token by another of the text or by one that is
// often mishandled; a stretch of tokens left out or doubled; the end cut off. Equal for an equal generator.
std::string Mutated(const std::string& text, std::mt19937_64& random);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_FUZZ_MUTATION_H_
