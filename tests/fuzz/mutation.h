// SPDX-License-Identifier: Apache-2.0
// Random changes to JSON texts. Equal for an equal generator.
#ifndef FLATLIGHT_TESTS_FUZZ_MUTATION_H_
#define FLATLIGHT_TESTS_FUZZ_MUTATION_H_

#include <random>
#include <string>

namespace flatlight {

// One change to the text: a bit of a byte, the end cut off, a number replaced by an extreme or impossible one, a token
// replaced, two swapped, a stretch left out or doubled. Mostly the result is not JSON any more.
std::string WithChangedText(const std::string& text, std::mt19937_64& random);

// One change to what the text says: a number replaced by an extreme one, a value removed, replaced or swapped with
// another, an element doubled, a member renamed. Texts that are not JSON stay as they are.
std::string WithChangedMeaning(const std::string& text, std::mt19937_64& random);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_FUZZ_MUTATION_H_
