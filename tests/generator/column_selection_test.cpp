#include "base_parameters/column_selection.hpp"

#include <gtest/gtest.h>

#include <random>

namespace idim::generator {

namespace {

using indices = std::vector<std::size_t>;

/// 30 x 6: columns 0 1 2 independent, 3 = 2 c0 - c1, 4 = 0, 5 = c2 / 2.
Eigen::MatrixXd sampled() {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    Eigen::MatrixXd W(30, 6);
    for (Eigen::Index i = 0; i < W.rows(); ++i) {
        W.row(i) << draw(random), draw(random), draw(random), 0.0, 0.0, 0.0;
    }
    W.col(3) = 2.0 * W.col(0) - W.col(1);
    W.col(5) = 0.5 * W.col(2);
    return W;
}

field_matrix matrix(const std::vector<std::vector<prime_field>>& rows) {
    field_matrix result(rows.front().size());
    for (const auto& row : rows) {
        result.append(row);
    }
    return result;
}

/// The same in exact numbers.
std::vector<std::vector<prime_field>> exact_rows() {
    std::mt19937_64 random(5);
    const prime_field two(std::uint64_t{2});
    std::vector<std::vector<prime_field>> rows;
    for (int i = 0; i < 30; ++i) {
        const prime_field a(random()), b(random()), c(random());
        rows.push_back({a, b, c, two * a - b, prime_field(), c / two});
    }
    return rows;
}

}  // namespace

TEST(ColumnSelection, KeepsWhatIsPreferredAndDropsWhatDependsOnIt) {
    const column_selection first = select_by_qr(sampled(), {0, 1, 2, 3, 4, 5}, 1e-9);
    EXPECT_EQ(first.kept, (indices{0, 1, 2}));
    EXPECT_EQ(first.dropped, (indices{3, 5}));  // 4 is zero: in neither
    const column_selection last = select_by_qr(sampled(), {5, 4, 3, 2, 1, 0}, 1e-9);
    EXPECT_EQ(last.kept, (indices{5, 3, 1}));
    EXPECT_EQ(last.dropped, (indices{2, 0}));
}

TEST(ColumnSelection, PivotsShowTheGap) {
    const column_selection chosen = select_by_qr(sampled(), {0, 1, 2, 3, 4, 5}, 1e-9);
    EXPECT_GT(chosen.smallest_kept, 0.1);
    EXPECT_LT(chosen.largest_dropped, 1e-14);  // rounding of a unit column
}

TEST(ColumnSelection, DoesNotDependOnTheUnitsOfColumns) {
    Eigen::MatrixXd W = sampled();
    const double scale[] = {1e-3, 1e3, 1e2, 1e-2, 1.0, 1e3};
    for (Eigen::Index c = 0; c < 6; ++c) {
        W.col(c) *= scale[c];
    }
    EXPECT_EQ(select_by_qr(W, {0, 1, 2, 3, 4, 5}, 1e-9).kept, (indices{0, 1, 2}));
}

TEST(ColumnSelection, ExactDecisionIsTheSameAndItsCoefficientsReproduceTheDroppedColumns) {
    const auto rows = exact_rows();
    for (const indices& preference :
         {indices{0, 1, 2, 3, 4, 5}, indices{5, 4, 3, 2, 1, 0}, indices{3, 0, 5, 1, 2, 4}}) {
        const exact_selection exact = select_exactly(matrix(rows), preference);
        const column_selection by_qr = select_by_qr(sampled(), preference, 1e-9);
        EXPECT_EQ(exact.kept, by_qr.kept);
        EXPECT_EQ(exact.dropped, by_qr.dropped);
        for (const auto& row : rows) {
            for (std::size_t d = 0; d < exact.dropped.size(); ++d) {
                prime_field sum;
                for (std::size_t k = 0; k < exact.kept.size(); ++k) {
                    sum = sum + exact.beta[k][d] * row[exact.kept[k]];
                }
                EXPECT_EQ(sum, row[exact.dropped[d]]);
            }
        }
    }
}

TEST(ColumnSelection, LeastSquaresReproduceTheDroppedColumns) {
    const Eigen::MatrixXd W = sampled();
    const Eigen::MatrixXd beta = express_by_qr(W, {5, 3, 1}, {2, 0});
    Eigen::MatrixXd expected(3, 2);
    expected << 2.0, 0.0, 0.0, 0.5, 0.0, 0.5;                   // c2 = 2 c5, c0 = (c3 + c1) / 2
    EXPECT_LE((beta - expected).cwiseAbs().maxCoeff(), 1e-14);  // rounding of 30 terms of order one
}

TEST(ColumnSelection, ExactDecisionDoesNotDependOnTheOrderOfTheRows) {
    // Rows of a chain of four links: row block i sees the columns of links i and further out, two of them dependent.
    std::mt19937_64 random(6);
    std::vector<std::vector<prime_field>> rows;
    for (std::size_t block = 0; block < 4; ++block) {
        for (int k = 0; k < 9; ++k) {
            std::vector<prime_field> row(8);
            for (std::size_t c = 2 * block; c < 8; ++c) {
                row[c] = prime_field(random());
            }
            row[3] = row[5] + row[6];
            row[1] = row[0] + row[7] + row[7];
            rows.push_back(row);
        }
    }
    const indices preference = {6, 7, 4, 5, 2, 0, 3, 1};
    const exact_selection expected = select_exactly(matrix(rows), preference);
    EXPECT_EQ(expected.kept, (indices{6, 7, 4, 5, 2, 0}));
    EXPECT_EQ(expected.dropped, (indices{3, 1}));
    for (int k = 0; k < 20; ++k) {
        for (std::size_t i = rows.size(); i > 1; --i) {
            std::swap(rows[i - 1], rows[random() % i]);
        }
        const exact_selection shuffled = select_exactly(matrix(rows), preference);
        EXPECT_EQ(shuffled.kept, expected.kept);
        EXPECT_EQ(shuffled.dropped, expected.dropped);
        EXPECT_EQ(shuffled.beta, expected.beta);
    }
}

TEST(ColumnSelection, FewerRowsThanColumnsLimitTheRank) {
    auto rows = exact_rows();
    rows.resize(2);
    EXPECT_EQ(select_exactly(matrix(rows), {0, 1, 2, 3, 4, 5}).kept.size(), 2u);
    EXPECT_TRUE(select_exactly(matrix({{prime_field(), prime_field()}}), {0, 1}).kept.empty());
}

}  // namespace idim::generator
