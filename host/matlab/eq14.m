function f = eq14(x, theta_i, theta_s)
% EQ14  The model in plane as a user of lsqcurvefit would write it: Eq. 3 to 14 of Bishop, Butler and Marciniak (2021).
%
%   x is [rho_d rho_s rho_v m n kappa], the angles are in DEGREES, f in sr^-1.

    ti = theta_i * pi / 180;
    ts = theta_s * pi / 180;
    % In plane theta_h and theta_d are half the difference and half the sum, and the other way round for the volume lobe.
    half_difference = abs(ti - ts) / 2;
    half_sum = abs(ti + ts) / 2;
    sigma = 1 ./ (4 * cos(ti) .* cos(ts));
    masking = min(1, 2 * cos(half_difference) .* min(cos(ti), cos(ts)) ./ cos(half_sum));
    f = x(1) / pi + x(2) * sigma .* beckmann(half_difference, x(4)) .* fresnel(half_sum, x(5), x(6)) .* masking ...
        + x(3) * beckmann(half_sum, x(4)) .* fresnel(half_difference, x(5), x(6));
end

function d = beckmann(theta_h, m)
    d = exp(-(tan(theta_h) / m).^2) ./ (pi * m^2 * cos(theta_h).^4);
end

function reflectance = fresnel(theta_d, n, kappa)
    index = n - 1i * kappa;
    c = cos(theta_d);
    t = sqrt(index^2 - sin(theta_d).^2);
    s = (c - t) ./ (c + t);
    p = (index^2 * c - t) ./ (index^2 * c + t);
    reflectance = (abs(s).^2 + abs(p).^2) / 2;
end
