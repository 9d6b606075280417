"""The terms of the page."""

from __future__ import annotations

from armscope.report.sectioning import Section, Subject

ENTRIES = (
    ("Mismatch, residual", "Measured tool position minus the position that the model predicts from the joint angles."),
    ("Free frames", "Where the robot's base is in the instrument's frame, and where the measured point is on the "
     "tool. Both are always fitted first: nobody knows them beforehand to a tenth of a millimetre."),
    ("RMS per axis", "Typical size of the residual: root of the mean square over all x, y and z values. The typical "
     "3D distance is 1.7 times as large."),
    ("Held-out rows", "Rows that took no part in finding or fitting the effects. A model that merely memorises the "
     "rows it has seen fails on them."),
    ("Noise", "What remains when the model is right: instrument and repeatability together, 1 sigma per axis."),
    ("Share of the mismatch", "How much of the squared residual after the free frames goes when an effect is cured as "
     "it was found, averaged over the orders in which all can be cured (Shapley's value). The shares of all effects and"
     " of small errors in the whole arm add up to what the whole model explains. One below zero partly cancels"
     " others."),
    ("Driver", "What an effect follows: a joint's angle, the load of gravity on it, temperature, time, ..."),
    ("Evidence, nats", "How much more probable the recordings are with the effect than without it, as a natural "
     "logarithm, after paying for the size of the library searched. 1 nat is odds of 3 to 1, 5 nats 150 to 1."),
    ("95 % interval", "Where the true number lies in 95 of 100 such analyses, if the name is right. Smooth errors that "
     "no effect explains are counted in, as large as what is left shows them to be."),
    ("Chosen in resampled data", "The rows are drawn again with replacement and the search is repeated: an effect that "
     "is chosen nearly every time does not depend on a few rows."),
    ("Compliance, stiffness", "How far something gives way per unit of load, and its reciprocal."),
    ("D-H row", "The four numbers (a, α, d, θ; Denavit and Hartenberg) that place one joint relative to the last."),
    ("µrad, mrad", "Millionth and thousandth of a radian. 1 mrad is 0.057° and moves a point 1 m away by 1 mm."),
)  # fmt: skip


GLOSSARY: Section[Subject] = Section("glossary", "Terms", "Terms", lambda subject: {"glossary": ENTRIES}, folded=True)
