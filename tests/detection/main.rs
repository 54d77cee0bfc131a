//! Detection: which boxes meet, how far shapes are apart, when they touch, what a ray hits.

mod broad_phase;
