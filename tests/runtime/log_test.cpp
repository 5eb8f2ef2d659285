#include "idim/log.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "../support/shared_data.hpp"
#include "idim/input_error.hpp"

namespace idim {
namespace {

using test_support::shared_data;

/// A directory of its own for every test.
class LogTest : public testing::Test {
  protected:
    LogTest()
        : directory_(std::filesystem::path(testing::TempDir()) /
                     (std::string("idim_log_") + testing::UnitTest::GetInstance()->current_test_info()->name())) {
        std::filesystem::create_directories(directory_);
    }
    ~LogTest() override { std::filesystem::remove_all(directory_); }

    std::string path(const std::string& name) const { return (directory_ / name).string(); }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }

    std::string write_gzip(const std::string& name, const std::string& text) const {
        const gzFile stream = gzopen(path(name).c_str(), "wb");
        EXPECT_EQ(gzwrite(stream, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
        EXPECT_EQ(gzclose(stream), Z_OK);
        return path(name);
    }

    /// Message of the input_error, without the directory.
    std::string error(const std::string& file, const log_columns& columns) const {
        try {
            read_log(file, columns);
        } catch (const input_error& caught) {
            std::string message = caught.what();
            EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
            EXPECT_EQ(message.rfind(directory_.string() + "/", 0), 0u) << message;
            return message.substr(directory_.string().size() + 1);
        }
        return "no error";
    }

    std::filesystem::path directory_;
};

const log_columns one_joint{{"slide"}, {0.0}, true};
const log_columns two_joints{{"shoulder", "elbow"}, {10.0, -2.0}, true};

TEST_F(LogTest, ColumnsAreFoundInAnyOrderAndUnknownOnesAreIgnored) {
    const log data =
        read_log(write("a.csv", "tau2,note,q2,t,q1,tau1\n4,hello,2,0,1,3\n40,,20,0.5,10,30\n"), two_joints);
    EXPECT_EQ(data.t, Eigen::Vector2d(0.0, 0.5));
    EXPECT_EQ(data.q, (Eigen::Matrix2d() << 1, 2, 10, 20).finished());
    EXPECT_EQ(data.tau, (Eigen::Matrix2d() << 3, 4, 30, 40).finished());
    EXPECT_EQ(data.qr.size(), 0);
    EXPECT_EQ(data.temp.size(), 0);
    EXPECT_EQ(data.duration(), 0.5);
}

TEST_F(LogTest, JointNamesAreAsGoodAsNumbers) {
    const log data = read_log(write("a.csv", "t,q_shoulder,q2,tau_elbow,tau1\n0,1,2,4,3\n"), two_joints);
    EXPECT_EQ(data.q, Eigen::RowVector2d(1, 2));
    EXPECT_EQ(data.tau, Eigen::RowVector2d(3, 4));
}

TEST_F(LogTest, OptionalSignalsAreRead) {
    const log data = read_log(write("a.csv", "t,q1,tau1,qr1,qd1,qdd1,temp1,v1\n0,1,2,3,4,5,6,7\n"), one_joint);
    EXPECT_EQ(data.qr(0, 0), 3.0);
    EXPECT_EQ(data.qd(0, 0), 4.0);
    EXPECT_EQ(data.qdd(0, 0), 5.0);
    EXPECT_EQ(data.temp(0, 0), 6.0);
    EXPECT_EQ(data.v(0, 0), 7.0);
}

TEST_F(LogTest, WithoutJointNamesTheHeaderCountsThem) {
    const log data = read_log(write("a.csv", "t,q1,q2,q3,tau1,tau2,tau3\n0,1,2,3,4,5,6\n"), {});
    EXPECT_EQ(data.q.cols(), 3);
}

TEST_F(LogTest, SpreadsheetHabitsAreAccepted) {
    const std::string text =
        "\xEF\xBB\xBF\"t\" , \"q1\",tau1,\"a, b\"\r\n 0 , +1.5e0,-2,x\r\n\"1\",\t3 ,+4.,y\r\n\r\n \r\n";
    const log data = read_log(write("a.csv", text), one_joint);
    EXPECT_EQ(data.t, Eigen::Vector2d(0, 1));
    EXPECT_EQ(data.q, Eigen::Vector2d(1.5, 3));
    EXPECT_EQ(data.tau, Eigen::Vector2d(-2, 4));
}

TEST_F(LogTest, LastLineNeedsNoEnd) {
    EXPECT_EQ(read_log(write("a.csv", "t,q1,tau1\n0,1,2\n1,2,3"), one_joint).samples(), 2);
}

TEST_F(LogTest, DriveCommandTimesGainIsTheTorque) {
    const log data = read_log(write("a.csv", "t,q1,q2,v1,v2\n0,0,0,0.5,3\n"), two_joints);
    EXPECT_EQ(data.tau, Eigen::RowVector2d(5.0, -6.0));
    EXPECT_EQ(data.v, Eigen::RowVector2d(0.5, 3.0));
}

TEST_F(LogTest, MeasuredTorqueComesBeforeTheDriveCommand) {
    EXPECT_EQ(read_log(write("a.csv", "t,q1,q2,v1,v2,tau1,tau2\n0,0,0,1,1,7,8\n"), two_joints).tau,
              Eigen::RowVector2d(7, 8));
}

TEST_F(LogTest, ReferenceFileNeedsNoTorque) {
    const log_columns reference{{"slide"}, {}, false};
    EXPECT_EQ(read_log(write("a.csv", "t,qr1\n0,1\n"), reference).qr(0, 0), 1.0);
    EXPECT_EQ(read_log(write("b.csv", "t,q1\n0,1\n"), reference).tau.size(), 0);
}

TEST_F(LogTest, GzipReadsAsThePlainFile) {
    std::string text = "t,q1,tau1\n";
    for (int k = 0; k < 200000; ++k) {  // longer than one read buffer
        text += std::to_string(k) + "," + std::to_string(0.001 * k) + ",1\n";
    }
    const log plain = read_log(write("a.csv", text), one_joint);
    const log zipped = read_log(write_gzip("a.csv.gz", text), one_joint);
    ASSERT_EQ(plain.samples(), 200000);
    EXPECT_EQ(plain.t, zipped.t);
    EXPECT_EQ(plain.q, zipped.q);
    EXPECT_EQ(plain.q(123456, 0), 123.456);
}

TEST_F(LogTest, LineLongerThanTheReadBufferIsRead) {
    const std::string blanks(3u << 20, ' ');
    EXPECT_EQ(read_log(write("a.csv", "t,q1,tau1\n0,1," + blanks + "5\n"), one_joint).tau(0, 0), 5.0);
}

TEST_F(LogTest, WrittenNumbersReadBackExactly) {
    log data;
    data.t = Eigen::Vector3d(-1.0 / 3.0, 0.1, 1e17 + 2.0);
    data.q = Eigen::Vector3d(std::numeric_limits<double>::min(), -0.0, std::numeric_limits<double>::max());
    data.tau = Eigen::Vector3d(std::nextafter(1.0, 2.0), std::numeric_limits<double>::denorm_min(), 12345.678);
    data.v = data.qr = data.qd = data.qdd = data.temp = Eigen::Vector3d(0.1, 0.2, 0.3);
    for (const char* name : {"a.csv", "a.csv.gz"}) {
        write_log(path(name), data);
        const log read = read_log(path(name), one_joint);
        EXPECT_EQ(read.t, data.t) << name;
        for (const auto signal : {&log::q, &log::tau, &log::v, &log::qr, &log::qd, &log::qdd, &log::temp}) {
            EXPECT_EQ(read.*signal, data.*signal) << name;
        }
    }
    EXPECT_TRUE(std::signbit(read_log(path("a.csv"), one_joint).q(1, 0)));
    EXPECT_EQ(std::ifstream(path("a.csv.gz"), std::ios::binary).get(), 0x1f) << "gzip";
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_), {}), 2) << "no temporary is left";
}

TEST_F(LogTest, WritingToNoDirectoryIsAnInputError) {
    log data;
    data.t = Eigen::VectorXd::Zero(1);
    EXPECT_THROW(write_log(path("none/a.csv"), data), input_error);
}

TEST_F(LogTest, MatrixOfAnotherLengthIsNotWritten) {
    log data;
    data.t = Eigen::VectorXd::Zero(2);
    data.q = Eigen::MatrixXd::Zero(3, 1);
    EXPECT_THROW(write_log(path("a.csv"), data), std::invalid_argument);
}

TEST_F(LogTest, MissingColumnIsNamedWithThoseThereAre) {
    EXPECT_EQ(error(write("a.csv", "time,q1,tau1\n0,1,2\n"), one_joint),
              "a.csv:1: t: this column is missing; the file has time, q1, tau1");
    EXPECT_EQ(error(write("a.csv", "t,pos,tau1\n0,1,2\n"), one_joint),
              "a.csv:1: q1 (or q_slide): this column is missing; the file has t, pos, tau1");
    EXPECT_EQ(error(write("a.csv", "t,q1\n0,1\n"), one_joint),
              "a.csv:1: tau1 (or tau_slide) or v1 (or v_slide): this column is missing; the file has t, q1");
}

TEST_F(LogTest, IsWrittenIntoAPipeAndDoesNotReplaceIt) {
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    const int reader = open(path("pipe").c_str(), O_RDWR);  // so that the writer need not wait for one
    ASSERT_GE(reader, 0);
    log data;
    data.t = Eigen::Vector2d(0.0, 0.5);
    data.q = Eigen::Vector2d(1.0, 2.0);
    write_log(path("pipe"), data);
    char first[2] = {};
    EXPECT_EQ(read(reader, first, sizeof first), 2);
    close(reader);
    EXPECT_EQ(std::string(first, 2), "t,");
    EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
}

TEST_F(LogTest, SignalOfSomeJointsOnlyIsAnError) {
    const log_columns three{{"a", "b", "c"}, {}, true};
    EXPECT_EQ(error(write("a.csv", "t,q1,q3,tau1,tau2,tau3\n0,1,2,3,4,5\n"), three),
              "a.csv:1: q2 (or q_b): this column is missing; the file has t, q1, q3, tau1, tau2, tau3");
    EXPECT_EQ(error(write("a.csv", "t,q1,q3,tau1,tau3\n0,1,2,3,4\n"), {}),
              "a.csv:1: q2: this column is missing; the file has t, q1, q3, tau1, tau3");
    EXPECT_EQ(error(write("a.csv", "t,q1,q2,tau1,tau2,temp2\n0,1,2,3,4,5\n"), two_joints),
              "a.csv:1: temp1 (or temp_shoulder): this column is missing; the file has t, q1, q2, tau1, tau2, temp2");
}

TEST_F(LogTest, DuplicateColumnIsAnError) {
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1,q1\n0,1,2,3\n"), one_joint),
              "a.csv:1: q1: this column stands twice in the header");
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1,q_slide\n0,1,2,3\n"), one_joint),
              "a.csv:1: q_slide: this column stands twice, also as q1");
}

TEST_F(LogTest, FieldCountMustMatchTheHeader) {
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,1,2\n1,2\n"), one_joint),
              "a.csv:3: tau1: too few fields, 2 where the header has 3");
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,1,2,3\n"), one_joint),
              "a.csv:2: too many fields, 4 where the header has 3");
}

TEST_F(LogTest, WhatIsNotAFiniteNumberIsAnError) {
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,1,2\n1,abc,2\n"), one_joint),
              "a.csv:3: q1: 'abc' where a finite number was expected");
    for (const std::string text : {"nan", "inf", "-inf", "1.5x", "+-1", "+", "0x10", "1;2", "1 2"}) {
        EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,1," + text + "\n"), one_joint),
                  "a.csv:2: tau1: '" + text + "' where a finite number was expected");
    }
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,1,1e999\n"), one_joint),
              "a.csv:2: tau1: '1e999' is out of the range of a double");
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,,1\n"), one_joint), "a.csv:2: q1: empty, a number was expected");
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0," + std::string(100, 'y') + ",1\n"), one_joint),
              "a.csv:2: q1: '" + std::string(40, 'y') + "...' where a finite number was expected");
}

TEST_F(LogTest, TimeMustIncrease) {
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,1,2\n0.25,1,2\n0.125,1,2\n"), one_joint),
              "a.csv:4: t: time must increase strictly, but 0.125 follows 0.25");
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,1,2\n0,1,2\n"), one_joint),
              "a.csv:3: t: time must increase strictly, but 0 follows 0");
}

TEST_F(LogTest, FileWithoutRowsIsAnError) {
    EXPECT_EQ(error(write("a.csv", ""), one_joint), "a.csv: the file is empty");
    EXPECT_EQ(error(write("a.csv.gz", ""), one_joint), "a.csv.gz: the file is empty");
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n"), one_joint), "a.csv: no rows after the header");
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n\n\n"), one_joint), "a.csv: no rows after the header");
}

TEST_F(LogTest, BlankLineBetweenRowsIsAnError) {
    EXPECT_EQ(error(write("a.csv", "t,q1,tau1\n0,1,2\n\n1,2,3\n"), one_joint),
              "a.csv:3: blank line before the last row");
}

TEST_F(LogTest, DriveCommandWithoutGainIsAnError) {
    EXPECT_EQ(error(write("a.csv", "t,q1,v1\n0,1,2\n"), one_joint),
              "a.csv:1: v1: a drive command needs the drive_gain of joint slide in the robot description");
}

TEST_F(LogTest, FileThatCannotBeReadIsAnError) {
    EXPECT_EQ(error(path("none.csv"), one_joint), "none.csv: cannot be opened: No such file or directory");
    EXPECT_EQ(error(write("a.csv.gz", "t,q1,tau1\n0,1,2\n"), one_joint),
              "a.csv.gz: is named .gz but is not a gzip file");
    std::filesystem::create_directories(path("directory"));
    EXPECT_EQ(error(path("directory"), one_joint), "directory: cannot be read: Is a directory");
}

TEST_F(LogTest, DamagedGzipIsAnError) {
    std::string text = "t,q1,tau1\n";
    for (int k = 0; k < 5000; ++k) {
        text += std::to_string(k) + "," + std::to_string(k * k % 977) + ",1\n";
    }
    const std::string whole = write_gzip("a.csv.gz", text);
    std::string bytes(std::filesystem::file_size(whole), '\0');
    std::ifstream(whole, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    for (const size_t length : {size_t{12}, bytes.size() / 2, bytes.size() - 9, bytes.size() - 3}) {
        EXPECT_EQ(error(write("b.csv.gz", bytes.substr(0, length)), one_joint)
                      .rfind("b.csv.gz: truncated or corrupt gzip file", 0),
                  0u)
            << length << " bytes of " << bytes.size();
    }
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
    EXPECT_EQ(error(write("b.csv.gz", bytes), one_joint).rfind("b.csv.gz: truncated or corrupt gzip file", 0), 0u);
}

TEST_F(LogTest, MeasuredRecordsAreRead) {
    const auto file = shared_data("panda/ident.csv.gz");
    if (!file) {
        GTEST_SKIP() << "panda/ident.csv.gz is not there; set IDIM_DATA";
    }
    const log data = read_log(file->string(), {});
    EXPECT_EQ(data.samples(), 13778);  // its README
    EXPECT_EQ(data.q.cols(), 7);
    EXPECT_EQ(data.q(0, 6), -0.164597);  // first row of the file
    EXPECT_EQ(data.qd.cols(), 7);
    EXPECT_EQ(data.qr.size(), 0) << "qdr is a reference velocity";
}

}  // namespace
}  // namespace idim
