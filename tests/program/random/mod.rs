//! Random input, the same in every run: what comes from outside ends as the documentation says, and
//! never in a panic or without an end.

mod call;
mod damage;
mod damaged_files;
mod damaged_recipes;
mod fewest_points;
mod recipes;
mod seeded;
mod targets;
mod valid_recipes;
