!> A thin layer of solid elements whose host hands in Green-Lagrange strain E and takes the second
!> Piola-Kirchhoff stress (docs/hosts.md, CalculiX under NLGEOM).
!>
!> The surfaces of a layer move apart by h d: d_3 along the normal of the lower one, g along it. Of
!> C = 1 + 2 E, c = (C_13, C_23) and e the strain in the plane,
!>
!>     g = c - e c,    (1 + d_3)^2 = C_33 - c.c + 2 c.e c
!>
!> which is exact where the plane does not stretch, whatever the slip and however the layer turns,
!> and to first order in e elsewhere. A slip s adds (s/h)^2/2 to E_33: taken for a gap it would open
!> the contact. Stress and stiffness follow from the power T.d' (work on an area, thickness h):
!> S = G^T T, dS/dE = G^T (h dT/du) G + T.d'', where G = d(d)/dE.
module friction_finite_layer
    use friction_host, only : hold_touching, host_update
    use friction_kinds, only : wp
    use friction_layer, only : first_friction_prop, layer_constants, make_symmetric, read_layer
    use friction_mod, only : friction_bad_increment, statev_size
    implicit none
    private

    public :: finite_layer_update

    !> Places in a strain of the host: 11, 22, 33, 12, 13, 23; shear is engineering shear.
    integer, parameter :: xx = 1, yy = 2, zz = 3, xy = 4, xz = 5, yz = 6

    !> How far the surfaces have moved, in thicknesses, with the derivatives by strain.
    type :: separation
        real(wp) :: d(3)           !! normal, tangential 1 and 2
        real(wp) :: by_e(3, 6)     !! d(d)/dE
        real(wp) :: curved(6, 6)   !! second derivative of (1 + d_3)^2
    end type separation

contains

    pure subroutine finite_layer_update(nprops, props, stran, dstran, dtime, statev, stress, &
        ddsdde, status)
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)   !! thickness [L], modulus [F/L^2], friction's
        real(wp), intent(in) :: stran(6)        !! at the start of the increment
        real(wp), intent(in) :: dstran(6)       !! its increment
        real(wp), intent(in) :: dtime           !! [T]
        real(wp), intent(inout) :: statev(statev_size)   !! state of the friction routine
        real(wp), intent(inout) :: stress(6)             !! out [F/L^2]
        real(wp), intent(inout) :: ddsdde(6, 6)          !! d(stress)/d(dstran), symmetric: without
                                                         !! the coupling of friction to pressure
        integer, intent(out) :: status          !! of the friction routine
        type(layer_constants) :: layer
        type(separation) :: old, new
        real(wp) :: du(3), traction(3), tangent(3, 3), shear(2, 2)
        logical :: usable

        call read_layer(nprops, props, layer, status)
        if (status < 0) return
        status = friction_bad_increment
        call separate(stran, old, usable)
        if (.not. usable) return
        call separate(stran + dstran, new, usable)
        if (.not. usable) return
        du = layer%thickness * (new%d - old%d)
        call host_update(3, du, dtime, nprops - first_friction_prop + 1, &
            props(first_friction_prop), statev, traction, tangent, status)
        if (status < 0) return
        call hold_touching(3, du, 0.0_wp, props(first_friction_prop), statev, tangent)
        tangent(2:3, 1) = 0.0_wp
        tangent = layer%thickness * tangent
        shear = tangent(2:3, 2:3)
        call make_symmetric(nprops, props, traction(2:3), shear)
        tangent(2:3, 2:3) = shear
        call put_stress(new, layer%modulus, stran + dstran, traction, stress)
        call put_stiffness(new, layer%modulus, traction, tangent, ddsdde)
    end subroutine finite_layer_update

    !> The separation that belongs to a strain. Where a layer is pressed through itself there is
    !> none.
    pure subroutine separate(e, this, usable)
        real(wp), intent(in) :: e(6)
        type(separation), intent(out) :: this
        logical, intent(out) :: usable
        integer, parameter :: widest = 100   ! strains of 2^100, whose powers do not overflow
        real(wp) :: q, by_q(6), in_plane(2), c(2)

        usable = maxval(exponent(e)) <= widest
        if (.not. usable) return
        c(1) = e(xz)
        c(2) = e(yz)
        in_plane(1) = e(xx) * c(1) + 0.5_wp * e(xy) * c(2)
        in_plane(2) = 0.5_wp * e(xy) * c(1) + e(yy) * c(2)
        q = 2.0_wp * e(zz) - c(1)**2 - c(2)**2 + 2.0_wp * (c(1) * in_plane(1) + c(2) * in_plane(2))
        usable = q > -1.0_wp
        if (.not. usable) return
        this%d(1) = q / (1.0_wp + sqrt(1.0_wp + q))
        this%d(2) = c(1) - in_plane(1)
        this%d(3) = c(2) - in_plane(2)

        by_q = [2.0_wp * c(1)**2, 2.0_wp * c(2)**2, 2.0_wp, 2.0_wp * c(1) * c(2), &
            4.0_wp * in_plane(1) - 2.0_wp * c(1), 4.0_wp * in_plane(2) - 2.0_wp * c(2)]
        this%by_e = 0.0_wp
        this%by_e(1, :) = by_q / (2.0_wp * (1.0_wp + this%d(1)))
        this%by_e(2, xx) = -c(1)
        this%by_e(2, xy) = -0.5_wp * c(2)
        this%by_e(2, xz) = 1.0_wp - e(xx)
        this%by_e(2, yz) = -0.5_wp * e(xy)
        this%by_e(3, yy) = -c(2)
        this%by_e(3, xy) = -0.5_wp * c(1)
        this%by_e(3, xz) = -0.5_wp * e(xy)
        this%by_e(3, yz) = 1.0_wp - e(yy)
        this%curved = 0.0_wp
        this%curved(xx, xz) = 4.0_wp * c(1)
        this%curved(yy, yz) = 4.0_wp * c(2)
        this%curved(xy, xz) = 2.0_wp * c(2)
        this%curved(xy, yz) = 2.0_wp * c(1)
        this%curved(xz, yz) = 2.0_wp * e(xy)
        this%curved = this%curved + transpose(this%curved)
        this%curved(xz, xz) = 4.0_wp * e(xx) - 2.0_wp
        this%curved(yz, yz) = 4.0_wp * e(yy) - 2.0_wp
    end subroutine separate

    !> In its plane the layer is elastic and does not contract sideways.
    pure subroutine put_stress(this, modulus, e, traction, stress)
        type(separation), intent(in) :: this
        real(wp), intent(in) :: modulus, e(6), traction(3)
        real(wp), intent(out) :: stress(6)
        integer :: i

        stress = 0.0_wp
        stress(xx) = modulus * e(xx)
        stress(yy) = modulus * e(yy)
        stress(xy) = 0.5_wp * modulus * e(xy)
        do i = 1, 3
            stress = stress + traction(i) * this%by_e(i, :)
        end do
    end subroutine put_stress

    pure subroutine put_stiffness(this, modulus, traction, tangent, ddsdde)
        type(separation), intent(in) :: this
        real(wp), intent(in) :: modulus, traction(3), tangent(3, 3)
        real(wp), intent(out) :: ddsdde(6, 6)
        real(wp) :: share, scaled(3, 6)
        integer :: i, j

        scaled = matmul(tangent, this%by_e)
        share = traction(1) / (1.0_wp + this%d(1))
        do j = 1, 6
            do i = 1, 6
                ddsdde(i, j) = dot_product(this%by_e(:, i), scaled(:, j)) &
                    + share * (0.5_wp * this%curved(i, j) - this%by_e(1, i) * this%by_e(1, j))
            end do
        end do
        call add_pair(xx, xz, -traction(2), ddsdde)
        call add_pair(xy, yz, -0.5_wp * traction(2), ddsdde)
        call add_pair(yy, yz, -traction(3), ddsdde)
        call add_pair(xy, xz, -0.5_wp * traction(3), ddsdde)
        ddsdde(xx, xx) = ddsdde(xx, xx) + modulus
        ddsdde(yy, yy) = ddsdde(yy, yy) + modulus
        ddsdde(xy, xy) = ddsdde(xy, xy) + 0.5_wp * modulus
    end subroutine put_stiffness

    pure subroutine add_pair(i, j, value, matrix)
        integer, intent(in) :: i, j
        real(wp), intent(in) :: value
        real(wp), intent(inout) :: matrix(6, 6)

        matrix(i, j) = matrix(i, j) + value
        matrix(j, i) = matrix(j, i) + value
    end subroutine add_pair

end module friction_finite_layer
