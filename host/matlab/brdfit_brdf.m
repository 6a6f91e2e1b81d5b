function f = brdfit_brdf(theta_i, theta_s, x, delta_phi, model)
% BRDFIT_BRDF  BRDF of the modified Cook-Torrance model, Eq. 14 of Bishop, Butler and Marciniak (2021), or of GGX.
%
%   f = brdfit_brdf(theta_i, theta_s, x)
%   f = brdfit_brdf(theta_i, theta_s, x, delta_phi)
%   f = brdfit_brdf(theta_i, theta_s, x, delta_phi, model)
%
%   theta_i, theta_s, delta_phi   angles in DEGREES as in brdfit_fit; theta_i and delta_phi may be one number
%   x                             [rho_d rho_s rho_v m n kappa], dimensionless
%   model                         'beckmann' for Eq. 14, or 'ggx'; 'beckmann'
%   f                             BRDF in sr^-1, of the size of theta_s
%
%   Errors: brdfit:badInput, brdfit:sizeMismatch, brdfit:badParameters, brdfit:badModel, brdfit:notFinite,
%   brdfit:beyondHorizon.
%
%   See also brdfit_fit.

    if nargin < 3 || nargin > 5
        error('brdfit:badInput', 'brdfit_brdf: takes theta_i, theta_s, x and, if need be, delta_phi and model');
    end
    if nargin < 5 || isempty(model)
        model = 'beckmann';
    end
    if nargin < 4 || isempty(delta_phi)
        delta_phi = 180;
    end
    if ~isnumeric(x) || ~isreal(x) || numel(x) ~= 6
        error('brdfit:badParameters', 'brdfit_brdf: x must have 6 real numbers');
    end
    count = numel(theta_s);
    radian = pi / 180;
    directions = [brdfit_row('theta_i', theta_i, count); brdfit_row('theta_s', theta_s, count); ...
        brdfit_row('delta_phi', delta_phi, count)] * radian;
    f = reshape(brdfit_mex('brdf', directions, reshape(double(x), 1, 6), brdfit_model(model)), size(theta_s));
end
