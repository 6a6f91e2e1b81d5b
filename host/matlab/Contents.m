% brdfit: parameters of BRDF models from scatterometer scans
%
%   brdfit_fit            - the parameters at the global optimum, their minima, their standard errors, and the residuals
%   brdfit_brdf           - the BRDF of a model at any angles
%   brdfit_program        - commands of the program: every model, terms by the scan, priors, robust fits, profiles
%   brdfit_build          - compiles the MEX from its static library
%
%   test_brdfit           - tests
%   compare_lsqcurvefit   - the paper's sets fitted by lsqcurvefit and by brdfit_fit
%   eq14                  - the model as one would write it for lsqcurvefit
