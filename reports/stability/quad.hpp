// Numbers of 113 bits (IEEE binary128), by which the program's own arithmetic is judged. Four operations are the
// compiler's; the functions below need nothing else, so that no library decides what is right.
#pragma once

#include <cmath>

namespace reports::stability {

__extension__ using Quad = __float128;

constexpr Quad absolute(Quad x) { return x < 0 ? -x : x; }

/// Newton's steps from the root of the nearest double.
inline Quad square_root(Quad x) {
    if (!(x > 0)) return 0;
    Quad root = std::sqrt(static_cast<double>(x));
    for (int i = 0; i < 3; ++i) root = (root + x / root) / 2;
    return root;
}

/// exp(x) - 1, without cancellation: the series of a small part, then (1 + e)^2 - 1 = e (2 + e) as often as halved.
inline Quad exponential_less_one(Quad x) {
    if (x < -200) return -1; // but for what 113 bits cannot hold beside 1
    int halvings = 0;
    while (absolute(x) > Quad(1) / 1024) {
        x /= 2;
        ++halvings;
    }
    Quad term = x, sum = x;
    for (int n = 2; n < 14; ++n) {
        term *= x / n;
        sum += term;
    }
    for (; halvings > 0; --halvings) sum *= 2 + sum;
    return sum;
}

inline Quad exponential(Quad x) {
    if (x < -11000) return 0;
    return x < 0 ? 1 / (1 + exponential_less_one(-x)) : 1 + exponential_less_one(x);
}

/// Newton's steps on exp(y) = x, for x > 0 in the range of double.
inline Quad logarithm(Quad x) {
    Quad y = std::log(static_cast<double>(x));
    for (int i = 0; i < 3; ++i) y -= 1 - x * exponential(-y);
    return y;
}

/// |got - want| / |want|; 0 where both are 0.
inline double relative_error(double got, Quad want) {
    if (want == 0) return std::fabs(got);
    return static_cast<double>(absolute(Quad(got) - want) / absolute(want));
}

} // namespace reports::stability
