# Reference motion of the demo: sums of sines below the bandwidth of each joint (1 and 10 rad/s), the first one driven beyond it, eased in over four seconds, as CSV.
# Variables: phase (shifts the phases, so that another value gives another motion), seconds.
BEGIN {
    pi = atan2(0, -1)
    split("0.03 0.05 0.08 0.12 0.17", slow, " ")
    split("0.11 0.19 0.31 0.47 0.67", fast, " ")
    print "t,qr1,qr2"
    for (k = 0; k <= seconds * 200; ++k) {
        t = k / 200
        ease = t < 4 ? (1 - cos(pi * t / 4)) / 2 : 1
        q1 = q2 = 0
        for (i = 1; i <= 5; ++i) {
            q1 += 2 * sin(2 * pi * slow[i] * t + phase * i * i)
            q2 += 0.8 * sin(2 * pi * fast[i] * t + phase * i * (i + 1))
        }
        printf "%.3f,%.12g,%.12g\n", t, ease * q1, ease * q2
    }
}
