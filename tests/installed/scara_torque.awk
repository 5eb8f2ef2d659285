# Closed form of the SCARA's torques (Janot, Vandanjon and Gautier 2010) along a motion t,q1,q2,qd1,qd2,qdd1,qdd2, to compare with.
function sign(x) { return (x > 0) - (x < 0) }
BEGIN { L = 0.5; ZZ1 = 3.44; Fv1 = 0.03; Fc1 = 0.82; ZZ2 = 0.062; MX2 = 0.242; MY2 = 0.014; Fv2 = 0.013; Fc2 = 0.137 }
NR > 1 {
    inertia = L * (MX2 * cos($3) - MY2 * sin($3))
    coriolis = L * (MX2 * sin($3) + MY2 * cos($3))
    tau1 = (ZZ1 + ZZ2 + 2 * inertia) * $6 + (ZZ2 + inertia) * $7 - coriolis * (2 * $4 * $5 + $5 * $5) + Fv1 * $4 + Fc1 * sign($4)
    tau2 = (ZZ2 + inertia) * $6 + ZZ2 * $7 + coriolis * $4 * $4 + Fv2 * $5 + Fc2 * sign($5)
    printf "%.6g %.6g\n", tau1, tau2
}
