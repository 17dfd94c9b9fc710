// Symmetric positive definite systems whose entries lie within BAND of the diagonal: what a strand's nodes, each tied
// to its neighbours only, have for a matrix. Solving is linear in their number (Golub, Van Loan. Matrix computations.
// Chapter 4.3: banded).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace coif::study
{

template <int BAND> class Banded
{
  public:
    explicit Banded(int size) : rows_(size) {}

    void clear() { std::fill(rows_.begin(), rows_.end(), std::array<double, BAND + 1>{}); }

    // The entries of the lower triangle only: `column` <= `row` <= `column` + BAND.
    double& at(int row, int column) { return rows_[row][row - column]; }

    // Takes an unknown out, so that it is solved for as 0 where its right side is.
    void hold(int unknown)
    {
        for (int k = 1; k <= BAND; ++k)
        {
            rows_[unknown][k] = 0.0;
            if (unknown + k < int(rows_.size()))
                rows_[unknown + k][k] = 0.0;
        }
        rows_[unknown][0] = 1.0;
    }

    void factor()
    {
        for (int i = 0; i < int(rows_.size()); ++i)
            for (int j = std::max(0, i - BAND); j <= i; ++j)
            {
                double sum = at(i, j);
                for (int k = std::max(0, i - BAND); k < j; ++k)
                    sum -= at(i, k) * at(j, k) * at(k, k);
                at(i, j) = i == j ? sum : sum / at(j, j);
            }
    }

    // The right side becomes the solution; of a factored matrix. T is a number or a vector of independent ones.
    template <typename T> void solve(std::vector<T>& side)
    {
        const int size = int(rows_.size());
        for (int i = 0; i < size; ++i)
            for (int k = std::max(0, i - BAND); k < i; ++k)
                side[i] -= at(i, k) * side[k];
        for (int i = size - 1; i >= 0; --i)
        {
            side[i] /= at(i, i);
            for (int k = i + 1; k <= std::min(i + BAND, size - 1); ++k)
                side[i] -= at(k, i) * side[k];
        }
    }

  private:
    std::vector<std::array<double, BAND + 1>> rows_;
};

} // namespace coif::study
