"""The paper's black-box models of positioning errors: polynomials and Fourier series, fitted by swarm."""
